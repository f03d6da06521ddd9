// leapfrog: kick–drift with half kicks at the frame's ends; the default.
#include "solvers/list.h"
#include "solvers/step_list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr auto kSteps = joined_steps(
    std::array{SolverStep{&pin_release, Block::substep}, SolverStep{&carry, Block::substep},
               SolverStep{&pair_check, Block::substep}, SolverStep{&cell_count, Block::substep},
               SolverStep{&cell_scan, Block::substep}, SolverStep{&cell_fill, Block::substep},
               SolverStep{&cell_sort, Block::substep}, SolverStep{&patch_near, Block::substep},
               SolverStep{&pair_gather, Block::substep}, SolverStep{&surface_gather, Block::substep},
               SolverStep{&touch_weight, Block::substep}, SolverStep{&surface_touch, Block::substep},
               SolverStep{&surface_contact, Block::substep}, SolverStep{&self_contact, Block::substep},
               SolverStep{&aerodynamics, Block::substep}, SolverStep{&integrate, Block::substep}},
    kAfterDrift,
    std::array{SolverStep{&tear, Block::substep}, SolverStep{&carry, Block::frame_end},
               SolverStep{&pair_check, Block::frame_end},  // what the last drift did
               SolverStep{&aerodynamics, Block::frame_end},
               SolverStep{&integrate, Block::frame_end},  // the closing half kick
               SolverStep{&normals, Block::frame_end}});

}  // namespace

const Solver leapfrog{
    .name = "leapfrog",
    .about = "second order, one pass a substep; the default",
    .source =
        "Hairer, Lubich and Wanner, Geometric numerical integration illustrated by the Stormer-Verlet "
        "method, Acta Numerica 12 (2003), eq. 1.5",
    .order = 2,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = leapfrog_step_max,
    .schedule = leapfrog_schedule,
    .force_evaluations_per_substep = 1,
};

}  // namespace weft
