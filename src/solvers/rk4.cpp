// rk4: the classical fourth-order Runge–Kutta method; in double it is the truth that errors are measured
// against. Air is an ordinary force; contact acts after each whole step, swept like a drift.
#include <array>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr std::array kSteps{
    SolverStep{&pin_release, Block::substep},  SolverStep{&rk4_first, Block::substep, 0},
    SolverStep{&pin_place, Block::substep, 0}, SolverStep{&rk4_middle, Block::substep, 1},
    SolverStep{&pin_place, Block::substep, 1}, SolverStep{&rk4_middle, Block::substep, 2},
    SolverStep{&pin_place, Block::substep, 2}, SolverStep{&rk4_last, Block::substep, 3},
    SolverStep{&pin_place, Block::substep, 3}, SolverStep{&normals, Block::frame_end}};

constexpr std::array kStages{StageRow{.weight = 1.0 / 6, .reach = 0.5, .time = 0.0},
                             StageRow{.weight = 1.0 / 3, .reach = 0.5, .time = 0.5},
                             StageRow{.weight = 1.0 / 3, .reach = 1.0, .time = 0.5},
                             StageRow{.weight = 1.0 / 6, .reach = 1.0, .time = 1.0}};

}  // namespace

const Solver rk4{
    .name = "rk4",
    .about = "classical Runge-Kutta, fourth order, four forces a substep; in double the converged truth",
    .source =
        "Kutta, Beitrag zur naeherungsweisen Integration totaler Differentialgleichungen (1901); "
        "Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I (1993), table II.1.2",
    .order = 4,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = [](const StepBound& bound) { return step_max(bound, 5.2, 4.0); },
    .schedule =
        [](double start_s, double frame_s, std::uint32_t substeps) {
          return runge_kutta_schedule(kStages, start_s, frame_s, substeps);
        },
    .force_evaluations_per_substep = 4,
    .rows_per_substep = kStages.size(),
};

}  // namespace weft
