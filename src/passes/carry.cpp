// carry: the motion that all of the cloth shares. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/surface.h"

namespace weft {
namespace {

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

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  auto& carrier = buffers[BufferId::carrier];
  carrier.assign(shared::kCarrierRows, glm::vec<4, T>(T(0)));
  if (!collision_layout(context.model).carried) return;
  const auto since = [&](BufferId from) {
    buffers[from].resize(grid.count());
    return mean_of_samples<T>(grid, [&](std::uint32_t p) {
      return place_in(buffers[BufferId::position], p) - place_in(buffers[from], p);
    });
  };
  carrier[shared::kCarrierBuilt] = since(BufferId::built_position);
  if (context.model.scene.floor || !context.model.scene.spheres.empty()) return;
  carrier[shared::kCarrierNear] = since(BufferId::near_position);
  carrier[shared::kCarrierVelocity] =
      mean_of_samples<T>(grid, [&](std::uint32_t p) { return place_in(buffers[BufferId::velocity], p); });
}

/// One workgroup.
Range domain(const Model& model) { return model.scene.self_collision ? Range{.x = 1, .y = 1} : Range{}; }

}  // namespace

const Pass carry{
    .name = "carry",
    .about = "self-collision: the motion that all of the cloth shares",
    .domain = domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .interval = contact_interval,
};

}  // namespace weft
