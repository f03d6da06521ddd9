// cell_sort: the members of each bucket in ascending order. Declaration and CPU mirror.
#include "passes/collision.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext&, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const auto& cells = buffers.words_of(BufferId::cells);
  auto& members = buffers.words_of(BufferId::cell_members);
  members = buffers.words_of(BufferId::cell_arrivals);
  for (std::size_t b = 0; b + 1 < cells.size(); ++b)
    std::sort(members.begin() + cells[b], members.begin() + cells[b + 1]);
}

}  // namespace

const Pass cell_sort = list_pass("cell_sort", "self-collision: makes the fill stable", mirror<float>,
                                 mirror<double>, shared::kBlockGroups, block_domain);

}  // namespace weft
