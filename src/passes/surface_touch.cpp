// surface_touch: distances of listed surfaces, and how far their particles may move. Declaration and CPU
// mirror.
#include <bit>

#include "passes/passes.h"
#include "passes/surface.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!contacts_due(buffers)) return;
  const CollisionView<T> view(context.model);
  auto& bounds = buffers.words_of(BufferId::surface_bound);
  auto& touches = buffers.words_of(BufferId::touch_weight);
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kContactGroups] = 0;
  std::uint32_t& gap = state[shared::kSmallestGap];
  bool any = false;
  for_each_surface_pair(view, buffers, [&](const SurfacePair<T>& pair) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(std::sqrt(pair.squared)));
    gap = std::min(gap, bits);
    const bool touching = pair.squared < view.surface_limit_squared;
    any |= touching;
    for (std::size_t m = 0; m < 4; ++m) {
      const std::uint32_t p = pair.particle[m];
      bounds[p] = std::min(bounds[p], bits);
      if (touching) touches[p] += touch_units(std::abs(pair.weight[m]));
    }
  });
  if (any) mark_touching(context.model.grid, buffers);
}

}  // namespace

const Pass surface_touch =
    collision_pass("surface_touch", "self-collision: distances of near triangles and edges", mirror<float>,
                   mirror<double>, shared::kContactGroups);

}  // namespace weft
