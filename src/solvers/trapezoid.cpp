// trapezoid: Heun's method, the explicit trapezoidal rule. Every undamped oscillation grows by (ωh)⁴/8 a
// step, so that long runs diverge; it is here to be compared.
#include <array>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{
    SolverStep{&pin_release, Block::substep},  SolverStep{&trapezoid_predict, Block::substep, 0},
    SolverStep{&pin_place, Block::substep, 0}, SolverStep{&trapezoid_correct, Block::substep, 1},
    SolverStep{&pin_place, Block::substep, 1}, SolverStep{&normals, Block::frame_end}};

/// The first slope reaches over the whole step; the second row's weight serves the mean of both.
constexpr std::array kStages{StageRow{.weight = 1.0, .reach = 1.0, .time = 0.0},
                             StageRow{.weight = 0.5, .reach = 1.0, .time = 1.0}};

}  // namespace

const Solver trapezoid{
    .name = "trapezoid",
    .about = "Heun's method, second order, two forces a substep; grows slowly without damping",
    .source =
        "Heun, Neue Methoden zur approximativen Integration der Differentialgleichungen (1900); "
        "Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I (1993), sect. II.1",
    .order = 2,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s =
        leapfrog_step_max,  // no step is stable without damping: leapfrog's, so that the two compare
    .schedule =
        [](double start_s, double frame_s, std::uint32_t substeps) {
          return runge_kutta_schedule(kStages, start_s, frame_s, substeps);
        },
    .instability = "makes every oscillation that is not damped grow, however short the step",
    .force_evaluations_per_substep = 2,
    .rows_per_substep = kStages.size(),
};

}  // namespace weft
