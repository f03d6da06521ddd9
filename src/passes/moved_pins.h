// What the passes over the particles of moving pins share: where they run, and the table that devices read.
#pragma once
#include <vector>

#include "passes/pass.h"

namespace weft {

/// Rows of kMovedPinsWide particles; empty where no pin moves.
inline Range moved_pins_range(const Model& model) {
  const auto count = static_cast<std::uint32_t>(model.moved_particles.size());
  return {.x = std::min(count, shared::kMovedPinsWide),
          .y = (count + shared::kMovedPinsWide - 1) / shared::kMovedPinsWide};
}

/// The buffer moved_pins: anchors in double, rounded once.
template <class T>
std::vector<shared::MovedPinOf<T>> make_moved_pins(const Model& model) {
  std::vector<shared::MovedPinOf<T>> table;
  table.reserve(model.moved_particles.size());
  for (const MovedParticle& held : model.moved_particles)
    table.push_back({glm::vec<3, T>(held.anchor_m), held.particle, held.pin});
  return table;
}

}  // namespace weft
