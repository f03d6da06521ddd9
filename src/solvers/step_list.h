// Lists of a solver's steps put together, and those that several solvers share.
#pragma once
#include <array>

#include "passes/passes.h"
#include "passes/spring_colours.h"
#include "solvers/solver.h"

namespace weft {

/// The steps of several lists, one after the other.
template <std::size_t... n>
constexpr std::array<SolverStep, (n + ...)> joined_steps(const std::array<SolverStep, n>&... lists) {
  std::array<SolverStep, (n + ...)> all{};
  std::size_t next = 0;
  const auto append = [&](const auto& list) {
    for (const SolverStep& step : list) all[next++] = step;
  };
  (append(lists), ...);
  return all;
}

/// What follows a drift: contact with what moves or leans, moving pins into their places, then springs that
/// are too long pulled back, colour by colour.
inline constexpr auto kAfterDrift = [] {
  std::array<SolverStep, 3 + kNearSpringColours> steps{};
  steps[0] = {&solid_contact, Block::substep};
  steps[1] = {&mesh_contact, Block::substep};
  steps[2] = {&pin_place, Block::substep};
  for (std::uint32_t item = 0; item < kNearSpringColours; ++item)
    steps[3 + item] = {&strain_limit, Block::substep, 0, item};
  return steps;
}();

}  // namespace weft
