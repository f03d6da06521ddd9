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

/// An output buffer of a pass, resized to the grid.
template <class T>
std::vector<glm::vec<4, T>>& output(HostBuffers<T>& buffers, const Model& model, BufferId id) {
  buffers[id].resize(model.grid.count());
  return buffers[id];
}

/// What the stages of a fourth-order step write: the next stage's state, where the step began, and the sums.
template <class T>
struct StageOutputs {
  using Buffer = std::vector<glm::vec<4, T>>;
  StageOutputs(HostBuffers<T>& buffers, const Model& model)
      : next_x(output(buffers, model, BufferId::position_next)),
        next_v(output(buffers, model, BufferId::velocity_next)),
        base_x(output(buffers, model, BufferId::base_position)),
        base_v(output(buffers, model, BufferId::base_velocity)),
        sum_x(output(buffers, model, BufferId::sum_position)),
        sum_v(output(buffers, model, BufferId::sum_velocity)) {}
  Buffer &next_x, &next_v, &base_x, &base_v, &sum_x, &sum_v;
};

template <class T>
void put(std::vector<glm::vec<4, T>>& buffer, std::size_t p, const Vec3<T>& value, T w = T(0)) {
  buffer[p] = glm::vec<4, T>(value, w);
}

}  // namespace weft
