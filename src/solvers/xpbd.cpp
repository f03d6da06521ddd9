// xpbd: extended position-based dynamics in small steps. Each substep is one prediction, one Gauss–Seidel
// sweep over the springs and bending triples, colour by colour, and velocities from positions. Stable at
// every step and too soft: first order, with an error that one sweep leaves.
#include "passes/xpbd.h"

#include <array>
#include <limits>

#include "passes/passes.h"
#include "solvers/list.h"
#include "solvers/step_rules.h"

namespace weft {
namespace {

constexpr auto kSteps = [] {
  std::array<SolverStep, 5 + kSpringColours + kBendColours> steps{};
  std::size_t next = 0;
  steps[next++] = {&xpbd_predict, Block::substep};
  steps[next++] = {&xpbd_pins, Block::substep};
  for (std::uint32_t item = 0; item < kSpringColours; ++item)
    steps[next++] = {&xpbd_spring, Block::substep, 0, item};
  for (std::uint32_t item = 0; item < kBendColours; ++item)
    steps[next++] = {&xpbd_bend, Block::substep, 0, item};
  steps[next++] = {&xpbd_finish, Block::substep};
  steps[next++] = {&pin_place, Block::substep};
  steps[next++] = {&normals, Block::frame_end};
  return steps;
}();

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
