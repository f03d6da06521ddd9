// symplectic-euler: leapfrog's pass without half kicks. As cheap and as stable; velocities lag by half a
// step.
#include "solvers/list.h"
#include "solvers/step_list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr auto kSteps = joined_steps(
    std::array{SolverStep{&pin_release, Block::substep}, SolverStep{&aerodynamics, Block::substep},
               SolverStep{&integrate, Block::substep}},
    kAfterDrift, std::array{SolverStep{&tear, Block::substep}, SolverStep{&normals, Block::frame_end}});

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
