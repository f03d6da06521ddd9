// What the stages of the Runge–Kutta passes share on the CPU: docs/solvers.md "Runge–Kutta stages".
#pragma once
#include "passes/substep.h"

namespace weft {

/// The slope of a stage's acceleration [m/s²], the drag of air as an ordinary force included.
template <class T>
Vec3<T> stage_acceleration(const Substep<T>& substep, const Particle<T>& stage, const Vec3<T>& force) {
  const Vec3<T> acceleration = substep.acceleration(force, stage.w);
  return substep.has_air ? acceleration - substep.row.loss * stage.v : acceleration;  // loss: α itself
}

/// A pass's output buffers, resized to the grid.
template <class T, std::size_t kCount>
std::array<std::vector<glm::vec<4, T>>*, kCount> outputs(HostBuffers<T>& buffers, const Model& model,
                                                         const std::array<BufferId, kCount>& ids) {
  std::array<std::vector<glm::vec<4, T>>*, kCount> out{};
  for (std::size_t i = 0; i < kCount; ++i) {
    out[i] = &buffers[ids[i]];
    out[i]->resize(model.grid.count());
  }
  return out;
}

template <class T>
void put(std::vector<glm::vec<4, T>>& buffer, std::size_t p, const Vec3<T>& value, T w = T(0)) {
  buffer[p] = glm::vec<4, T>(value, w);
}

}  // namespace weft
