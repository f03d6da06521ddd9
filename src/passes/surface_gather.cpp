// surface_gather: the triangles near each particle and the pairs of edges near each other. Declaration and
// CPU mirror.
#include <algorithm>
#include <atomic>
#include <utility>

#include "passes/lists.h"
#include "passes/parallel.h"
#include "passes/passes.h"
#include "passes/surface_search.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_in_making(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  const std::size_t count = grid.count();
  auto& counts = buffers.words_of(BufferId::surface_count);
  auto& entries = buffers.words_of(BufferId::surface_pairs);
  entries.resize(count * view.layout.surface_capacity);
  const PatchGrid patches(grid);
  const SurfaceSearch<T> search(view, patches, buffers);
  std::atomic<std::uint32_t> dropped = 0, listed = 0;
  const auto& position = std::as_const(buffers)[BufferId::position];
  const auto& asked = buffers.words_of(BufferId::patch_listed);
  each_looker(view, buffers, [&](std::uint32_t p) {
    if (!view.covered(position[p])) return;
    std::uint32_t found = 0;
    const auto keep = [&](std::uint32_t code, std::uint32_t place) {
      if (found < view.layout.surface_capacity)
        entries[found * count + p] = code << shared::kSurfaceCodeShift | place;
      ++found;
    };
    const auto around = [&](const auto& look_at) {
      return search.search().particles_around(patches, p, place_in(position, p),
                                              search.search().surface_distance(), look_at);
    };
    if (!search.run(p, asked[patches.with(p)], around, keep)) ++dropped;
    counts[p] = std::min(found, view.layout.surface_capacity);
    dropped += found - counts[p];
    listed |= counts[p];
  });
  buffers.words_of(BufferId::collision_state)[shared::kPairsDropped] += dropped;
  end_lists(buffers);
  if (listed != 0) mark_listed(grid, buffers);
}

}  // namespace

const Pass surface_gather = list_pass("surface_gather", "self-collision: lists of near triangles and edges",
                                      mirror<float>, mirror<double>, shared::kNearGroups);

}  // namespace weft
