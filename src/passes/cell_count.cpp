// cell_count: how many particles each bucket of the grid holds. Declaration and CPU mirror.
#include "passes/collision.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const auto& position = buffers[BufferId::position];
  auto& cells = buffers.words_of(BufferId::cells);
  for (std::uint32_t p = 0; p < position.size(); ++p) ++cells[view.bucket_of(view.cell_of(position[p], p))];
  buffers[BufferId::built_position] = position;
}

}  // namespace

const Pass cell_count{
    .name = "cell_count",
    .about = "self-collision: particles in each bucket of the grid",
    .domain = collision_domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .interval = contact_interval,
    .groups_word = shared::kListGroups,
};

}  // namespace weft
