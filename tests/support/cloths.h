// Scenes of several cloths: one of them alone, and its share of a state.
#pragma once
#include <cstddef>

#include "model/model.h"

namespace weft::testing_support {

/// The scene with its k-th cloth and what holds that.
inline Scene alone(const Scene& scene, std::uint32_t k) {
  Scene one = scene;
  one.cloth = cloth_of(scene, k);
  one.cloths.clear();
  std::erase_if(one.pins, [k](const PinSection& pin) { return pin.cloth != k; });
  for (PinSection& pin : one.pins) pin.cloth = 0;
  return one;
}

/// What a state of all cloths says of the k-th.
inline State part_of(const Grid& grid, const State& state, std::uint32_t k) {
  const auto first = static_cast<std::ptrdiff_t>(k * grid.nx * grid.ny),
             count = std::ptrdiff_t{grid.nx} * grid.ny;
  return {.position = {state.position.begin() + first, state.position.begin() + first + count},
          .velocity = {state.velocity.begin() + first, state.velocity.begin() + first + count},
          .time_s = state.time_s};
}

}  // namespace weft::testing_support
