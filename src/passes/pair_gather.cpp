// pair_gather: the pairs that may touch before the lists are made anew. Declaration and CPU mirror.
#include <atomic>
#include <utility>

#include "passes/collision.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// Writes the list of one particle and returns how many entries found no room.
template <class T>
std::uint32_t gather(const CollisionView<T>& view, std::uint32_t particle, HostBuffers<T>& buffers) {
  const auto& position = std::as_const(buffers)[BufferId::position];
  const auto& cells = buffers.words_of(BufferId::cells);
  const auto& members = buffers.words_of(BufferId::cell_members);
  auto& places = buffers.words_of(BufferId::pair_places);
  if (!view.covered(position[particle])) {
    buffers.words_of(BufferId::pair_count)[particle] = 0;
    return 0;
  }
  const auto corner = view.corner_cell(position[particle]);
  std::uint32_t found = 0;
  for (int k = 0; k < 8; ++k) {
    const typename CollisionView<T>::Cell cell{corner[0] + k % 2, corner[1] + k / 2 % 2, corner[2] + k / 4};
    const std::uint32_t bucket = view.bucket_of(cell);
    for (std::uint32_t slot = cells[bucket]; slot < cells[bucket + 1]; ++slot) {
      const std::uint32_t other = view.particle_at(members[slot]);
      if (other == particle || view.cell_of(position[other], other) != cell) continue;
      const T q = squared_distance(position[particle], position[other]);
      if (!(q < view.limit(particle, other).reach_squared)) continue;
      if (found < view.layout.capacity)
        places[std::size_t{found} * position.size() + particle] = members[slot];
      ++found;
    }
  }
  const std::uint32_t kept = std::min(found, view.layout.capacity);
  buffers.words_of(BufferId::pair_count)[particle] = kept;
  return found - kept;
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  buffers.words_of(BufferId::pair_count).resize(grid.count());
  buffers.words_of(BufferId::pair_places).resize(std::size_t{grid.count()} * view.layout.capacity);
  std::atomic<std::uint32_t> dropped = 0;
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) dropped += gather(view, p, buffers);
  });
  buffers.words_of(BufferId::collision_state)[shared::kPairsDropped] += dropped;
  if (std::ranges::any_of(buffers.words_of(BufferId::pair_count), [](auto n) { return n > 0; }))
    mark_listed(grid, buffers);
}

}  // namespace

const Pass pair_gather =
    collision_pass("pair_gather", "self-collision: lists of the pairs within limit and skin", mirror<float>,
                   mirror<double>, shared::kListGroups);

}  // namespace weft
