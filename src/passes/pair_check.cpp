// pair_check: whether the pair lists still hold, and an empty grid. Declaration and CPU mirror.
#include "passes/collision.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const CollisionView<T> view(context.model);
  const auto& position = buffers[BufferId::position];
  const auto& built = buffers[BufferId::built_position];
  buffers.words_of(BufferId::cells).assign(view.layout.buckets + 1, 0);
  const glm::vec<4, T> drifted = position[view.layout.centre] - built[view.layout.centre];
  bool stale = false;
  for (std::size_t p = 0; p < position.size(); ++p) {
    const T q = squared_distance(drifted, position[p] - built[p]);
    if (!(q <= view.moved_squared_max)) stale = true;
  }
  if (!stale) return;
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kListGroups] = (view.grid.nx + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
  state[shared::kScanGroups] = 1;
}

}  // namespace

const Pass pair_check{
    .name = "pair_check",
    .about = "self-collision: do the pair lists still hold? empties the grid",
    .domain = collision_domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .interval = contact_interval,
};

}  // namespace weft
