// xpbd: extended position-based dynamics in small steps. Each substep is one prediction, one Gauss–Seidel
// sweep over the springs and bending triples, colour by colour, and velocities from positions. Stable at
// every step and too soft: first order, with an error that one sweep leaves.
#include "passes/xpbd.h"

#include <array>
#include <limits>

#include "solvers/list.h"
#include "solvers/step_list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

/// One sweep: each colour of springs, then each of bending triples.
constexpr auto kSweep = [] {
  std::array<SolverStep, kSpringColours + kBendColours> steps{};
  std::size_t next = 0;
  for (std::uint32_t item = 0; item < kSpringColours; ++item)
    steps[next++] = {&xpbd_spring, Block::substep, 0, item};
  for (std::uint32_t item = 0; item < kBendColours; ++item)
    steps[next++] = {&xpbd_bend, Block::substep, 0, item};
  return steps;
}();

constexpr auto kSteps = joined_steps(
    std::array{SolverStep{&pin_release, Block::substep}, SolverStep{&aerodynamics, Block::substep},
               SolverStep{&xpbd_predict, Block::substep}, SolverStep{&xpbd_pins, Block::substep}},
    kSweep, std::array{SolverStep{&xpbd_tethers, Block::substep}, SolverStep{&xpbd_finish, Block::substep}},
    kAfterDrift, std::array{SolverStep{&normals, Block::frame_end}});

}  // namespace

const Solver xpbd{
    .name = "xpbd",
    .about = "small steps, one sweep each: stable at any step, fast and too soft",
    .source =
        "Macklin, Mueller and Chentanez, XPBD (2016), eq. 18 and 26; Macklin et al., Small steps in physics "
        "simulation (2019), algorithm 1",
    .order = 1,
    .on_gpu = true,
    .steps = kSteps,
    .step_max_s = [](const StepBound&) { return std::numeric_limits<double>::infinity(); },
    .schedule = whole_kick_schedule,
    .force_evaluations_per_substep = 1,
    .substeps_default = 20,
};

}  // namespace weft
