// pair_gather: the pairs that may touch before the lists are made anew. Declaration and CPU mirror.
#include <algorithm>
#include <atomic>
#include <utility>

#include "passes/collision.h"
#include "passes/parallel.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft {
namespace {

/// Writes the list of one particle and returns how many entries there were, those without room as well.
/// @param widest  the largest square of limit and skin [m²]: most others are beyond any
template <class T>
std::uint32_t gather(const CollisionView<T>& view, const PatchGrid& patches, const PatchSearch<T>& search,
                     std::uint32_t particle, T widest, HostBuffers<T>& buffers) {
  const auto& position = std::as_const(buffers)[BufferId::position];
  auto& places = buffers.words_of(BufferId::pair_places);
  std::uint32_t found = 0;
  const auto add = [&](std::uint32_t other) {
    const T q = squared_distance(position[particle], position[other]);
    if (!(q < widest) || !(q < view.limit(particle, other).reach_squared)) return;
    if (found < view.layout.capacity)
      places[std::size_t{found} * position.size() + particle] = view.place_of(other);
    ++found;
  };
  if (!view.covered(position[particle]) ||
      (buffers.words_of(BufferId::patch_listed)[patches.with(particle)] & shared::kLooksFar) == 0)
    return 0;
  search.particles_around(patches, particle, place_in(position, particle), view.pair_reach, add);
  buffers.words_of(BufferId::pair_count)[particle] = std::min(found, view.layout.capacity);
  return found;
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_in_making(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  buffers.words_of(BufferId::pair_places).resize(std::size_t{grid.count()} * view.layout.capacity);
  const PatchGrid patches(grid);
  const PatchSearch<T> search(view, buffers);
  const T widest = std::ranges::max(view.limits, {}, &PairLimit<T>::reach_squared).reach_squared;
  std::atomic<std::uint32_t> dropped = 0, listed = 0;
  each_looker(view, buffers, [&](std::uint32_t p) {
    const std::uint32_t found = gather(view, patches, search, p, widest, buffers);
    dropped += found - std::min(found, view.layout.capacity);
    listed |= found;
  });
  buffers.words_of(BufferId::collision_state)[shared::kPairsDropped] += dropped;
  if (listed != 0) mark_listed(grid, buffers);
}

}  // namespace

const Pass pair_gather = list_pass("pair_gather", "self-collision: lists of the pairs within limit and skin",
                                   mirror<float>, mirror<double>, shared::kNearGroups);

}  // namespace weft
