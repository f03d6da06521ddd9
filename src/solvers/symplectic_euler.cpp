// symplectic-euler: leapfrog's pass without half kicks. As cheap and as stable; velocities lag by half a
// step.
#include <array>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{SolverStep{&integrate, Block::substep}, SolverStep{&pin_place, Block::substep},
                            SolverStep{&normals, Block::frame_end}};

}  // namespace

const Solver symplectic_euler{
    .name = "symplectic-euler",
    .about = "first order, one pass a substep: leapfrog without its half kicks",
    .source =
        "Hairer, Lubich and Wanner, Geometric numerical integration illustrated by the Stormer-Verlet "
        "method, Acta Numerica 12 (2003), eq. 1.9",
    .order = 1,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = leapfrog_step_max,
    .schedule = whole_kick_schedule,
    .force_evaluations_per_substep = 1,
};

}  // namespace weft
