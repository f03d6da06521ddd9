// cell_fill: every particle takes a slot of its bucket. Declaration and CPU mirror.
#include "passes/collision.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// From the last particle to the first, so that the slots of a bucket, counted down, ascend.
template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const auto& position = buffers[BufferId::position];
  auto& cells = buffers.words_of(BufferId::cells);
  auto& arrivals = buffers.words_of(BufferId::cell_arrivals);
  arrivals.resize(position.size());
  for (auto p = static_cast<std::uint32_t>(position.size()); p-- > 0;)
    arrivals[--cells[view.bucket_of(view.cell_of(position[p], p))]] = view.place_of(p);
}

/// On the device the order within a bucket is that of arrival.
void settle_order(HostWords& buffers) {
  if (!lists_stale(buffers)) return;
  const auto& cells = buffers.words_of(BufferId::cells);
  auto& arrivals = buffers.words_of(BufferId::cell_arrivals);
  for (std::size_t b = 0; b + 1 < cells.size(); ++b)
    if (cells[b] <= cells[b + 1] && cells[b + 1] <= arrivals.size())
      std::sort(arrivals.begin() + cells[b], arrivals.begin() + cells[b + 1]);
}

}  // namespace

const Pass cell_fill =
    collision_pass("cell_fill", "self-collision: particles into their buckets, as they come", mirror<float>,
                   mirror<double>, shared::kListGroups, settle_order);

}  // namespace weft
