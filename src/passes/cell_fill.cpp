// cell_fill: every patch takes a slot of its bucket. Declaration and CPU mirror.
#include "passes/collision.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft {
namespace {

/// From the last block to the first, so that the slots of a bucket, counted down, ascend.
template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const std::uint32_t count = PatchGrid(context.model.grid).block_count();
  const PatchSearch<T> search(view, buffers);
  auto& cells = buffers.words_of(BufferId::cells);
  auto& arrivals = buffers.words_of(BufferId::cell_arrivals);
  arrivals.resize(count);
  for (std::uint32_t b = count; b-- > 0;) arrivals[--cells[view.bucket_of(search.cell_of(b))]] = b;
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
    list_pass("cell_fill", "self-collision: blocks into their buckets, as they come", mirror<float>,
              mirror<double>, shared::kBlockGroups, block_domain, settle_order);

}  // namespace weft
