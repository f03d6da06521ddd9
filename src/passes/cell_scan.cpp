// cell_scan: counts become the ends of the buckets. Declaration and CPU mirror.
#include <numeric>

#include "passes/lists.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext&, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  auto& cells = buffers.words_of(BufferId::cells);
  std::partial_sum(cells.begin(), cells.end() - 1, cells.begin());
  cells.back() = cells[cells.size() - 2];
  count_lists(buffers);
}

/// One workgroup.
Range domain(const Model& model) { return model.scene.self_collision ? Range{.x = 1, .y = 1} : Range{}; }

}  // namespace

const Pass cell_scan =
    list_pass("cell_scan", "self-collision: prefix sum, from counts to the ends of the buckets",
              mirror<float>, mirror<double>, shared::kScanGroups, domain);

}  // namespace weft
