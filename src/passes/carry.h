// The motion that all of a cloth shares, of particles wherever they are kept. Operation by operation as
// docs/float-form.md "Shared motion".
#pragma once
#include <array>

#include "passes/collision.h"

namespace weft {

/// The mean of vectors at the samples; halves are added to halves, as the device does.
template <class T, class At>
glm::vec<4, T> mean_of_samples(const Grid& grid, At&& at) {
  std::array<glm::vec<3, T>, shared::kCarrierSamples> sum;
  for (std::uint32_t k = 0; k < sum.size(); ++k)
    sum[k] = at(grid.index((2 * (k % 8) + 1) * grid.nx / 16, (2 * (k / 8) + 1) * grid.rows() / 16));
  for (std::size_t half = sum.size() / 2; half > 0; half /= 2)
    for (std::size_t k = 0; k < half; ++k) sum[k] = sum[k] + sum[k + half];
  return {sum[0] / static_cast<T>(shared::kCarrierSamples), T(0)};
}

/// Writes `carrier`.
/// @param is_shared         as shares_motion has it
/// @param place, velocity  of a particle, as vectors of three [m, m/s]
template <class T, class Place, class Velocity>
void carry_along(const Model& model, bool is_shared, HostBuffers<T>& buffers, Place&& place,
                 Velocity&& velocity) {
  const Grid& grid = model.grid;
  auto& carrier = buffers[BufferId::carrier];
  carrier.assign(shared::kCarrierRows, glm::vec<4, T>(T(0)));
  if (!is_shared) return;
  const auto since = [&](BufferId from) {
    buffers[from].resize(grid.count());
    return mean_of_samples<T>(grid,
                              [&](std::uint32_t p) { return place(p) - glm::vec<3, T>(buffers[from][p]); });
  };
  carrier[shared::kCarrierBuilt] = since(BufferId::built_position);
  if (model.scene.floor || !model.scene.spheres.empty()) return;
  carrier[shared::kCarrierNear] = since(BufferId::near_position);
  carrier[shared::kCarrierVelocity] = mean_of_samples<T>(grid, velocity);
}

}  // namespace weft
