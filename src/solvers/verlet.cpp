// verlet: x₊ = 2x − x₋ + acc·h², as cloth demos teach it. Second order, and in float32 unusable below about
// 200 us, because acc·h² falls under the last bit of x: it is here to show that.
#include <array>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{SolverStep{&pin_release, Block::substep},
                            SolverStep{&verlet_step, Block::substep}, SolverStep{&pin_place, Block::substep},
                            SolverStep{&integrate, Block::frame_end},  // half a kick: x and v at one time
                            SolverStep{&normals, Block::frame_end}};

}  // namespace

const Solver verlet{
    .name = "verlet",
    .about = "second order, positions only; in f32 useless below 200 us a step",
    .source =
        "Verlet, Phys. Rev. 159 (1967) 98, eq. 4; in cloth: Jakobsen, Advanced character physics (2001)",
    .order = 2,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = leapfrog_step_max,
    .schedule = leapfrog_schedule,
    .force_evaluations_per_substep = 1,
};

}  // namespace weft
