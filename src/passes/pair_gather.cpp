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

/// Writes the list of one particle and returns how many entries found no room.
template <class T>
std::uint32_t gather(const CollisionView<T>& view, const PatchGrid& patches, const PatchSearch<T>& search,
                     std::uint32_t particle, HostBuffers<T>& buffers) {
  const auto& position = std::as_const(buffers)[BufferId::position];
  auto& places = buffers.words_of(BufferId::pair_places);
  std::uint32_t found = 0;
  const auto add = [&](std::uint32_t other) {
    const T q = squared_distance(position[particle], position[other]);
    if (!(q < view.limit(particle, other).reach_squared)) return;
    if (found < view.layout.capacity)
      places[std::size_t{found} * position.size() + particle] = view.place_of(other);
    ++found;
  };
  if (view.covered(position[particle]))
    search.particles_around(patches, particle, place_in(position, particle), view.pair_reach, add);
  const std::uint32_t kept = std::min(found, view.layout.capacity);
  buffers.words_of(BufferId::pair_count)[particle] = kept;
  return found - kept;
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_in_making(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  buffers.words_of(BufferId::pair_count).resize(grid.count());
  buffers.words_of(BufferId::pair_places).resize(std::size_t{grid.count()} * view.layout.capacity);
  buffers[BufferId::built_position] = std::as_const(buffers)[BufferId::position];
  const PatchGrid patches(grid);
  const PatchSearch<T> search(view, buffers);
  std::atomic<std::uint32_t> dropped = 0;
  const auto& asked = buffers.words_of(BufferId::patch_listed);
  std::ranges::fill(buffers.words_of(BufferId::pair_count), 0u);
  parallel_rows(patches.rows(), 2 * std::uint64_t{grid.nx}, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t patch = begin * patches.nx(); patch < end * patches.nx(); ++patch)
      if ((asked[patch] & shared::kLooksFar) != 0)
        patches.each_particle(patch,
                              [&](std::uint32_t p) { dropped += gather(view, patches, search, p, buffers); });
  });
  buffers.words_of(BufferId::collision_state)[shared::kPairsDropped] += dropped;
  if (std::ranges::any_of(buffers.words_of(BufferId::pair_count), [](auto n) { return n > 0; }))
    mark_listed(grid, buffers);
}

}  // namespace

const Pass pair_gather = list_pass("pair_gather", "self-collision: lists of the pairs within limit and skin",
                                   mirror<float>, mirror<double>, shared::kNearGroups);

}  // namespace weft
