// velocity-verlet: leapfrog's positions, with damping evaluated at a velocity predicted for the same instant:
// second order with damping too, for a shorter stable step.
#include <array>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{SolverStep{&pin_release, Block::substep},
                            SolverStep{&velocity_verlet_step, Block::substep},
                            SolverStep{&pin_place, Block::substep},
                            SolverStep{&velocity_verlet_step, Block::frame_end},  // completes the last step
                            SolverStep{&normals, Block::frame_end}};

/// Leapfrog's kicks and drifts; after each but the closing one a further half kick predicts the velocity at
/// the drift's end.
std::vector<KickDrift> schedule(double start_s, double frame_s, std::uint32_t substeps) {
  std::vector<KickDrift> rows = leapfrog_schedule(start_s, frame_s, substeps);
  for (KickDrift& row : rows) row.predict_s = 0.5 * row.drift_s;
  return rows;
}

}  // namespace

const Solver velocity_verlet{
    .name = "velocity-verlet",
    .about = "second order with damping too, one pass a substep",
    .source =
        "Swope, Andersen, Berens and Wilson, J. Chem. Phys. 76 (1982) 637, appendix; the predicted velocity "
        "v + h·acc: Groot and Warren, J. Chem. Phys. 107 (1997) 4423, eq. 13 with lambda = 1",
    .order = 2,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = [](const StepBound& bound) { return step_max(bound, 2.0, 1.0); },
    .schedule = schedule,
    .force_evaluations_per_substep = 1,
};

}  // namespace weft
