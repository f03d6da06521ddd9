// cell_count: how many particles each bucket of the grid holds, and the longest edge. Declaration and CPU
// mirror.
#include <bit>

#include "passes/passes.h"
#include "passes/surface.h"

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
  std::uint32_t& longest = buffers.words_of(BufferId::collision_state)[shared::kLongestEdge];
  for (std::uint32_t p = 0; p < position.size(); ++p)
    for (const std::size_t k : {0u, 1u, 2u})  // right, below, below to the left
      if (const auto q = ring_particle(context.model.grid, p, k))
        longest = std::max(longest, std::bit_cast<std::uint32_t>(
                                        static_cast<float>(squared_distance(position[p], position[*q]))));
}

}  // namespace

const Pass cell_count = collision_pass("cell_count", "self-collision: particles in each bucket of the grid",
                                       mirror<float>, mirror<double>, shared::kListGroups);

}  // namespace weft
