// euler: explicit Euler. Every undamped oscillation grows by (ωh)²/2 a step, so it fails; it is here to be
// seen.
#include <array>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{SolverStep{&pin_release, Block::substep}, SolverStep{&euler_step, Block::substep},
                            SolverStep{&pin_place, Block::substep}, SolverStep{&normals, Block::frame_end}};

}  // namespace

const Solver euler{
    .name = "euler",
    .about = "first order, unstable whatever the step: shown because it fails",
    .source =
        "Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I (1993), sect. II.1, eq. 1.3",
    .order = 1,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = leapfrog_step_max,  // there is no stable step: leapfrog's, so that the two compare
    .schedule = whole_kick_schedule,
    .instability = "gains energy in every oscillation, however short the step",
    .force_evaluations_per_substep = 1,
};

}  // namespace weft
