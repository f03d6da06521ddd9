// touch_weight: the pairs of each particle that are nearer than their limit, weighed. Declaration and CPU
// mirror.
#include <utility>

#include "passes/collision.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!contacts_due(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  const auto& position = std::as_const(buffers)[BufferId::position];
  const auto& counts = buffers.words_of(BufferId::pair_count);
  const auto& places = buffers.words_of(BufferId::pair_places);
  auto& touches = buffers.words_of(BufferId::touch_weight);
  touches.resize(grid.count());
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      touches[p] = 0;
      for (std::size_t k = 0; k < counts[p]; ++k) {
        const std::uint32_t other = view.particle_at(places[k * position.size() + p]);
        touches[p] += squared_distance(position[p], position[other]) < view.limit(p, other).squared
                          ? touch_units(T(1))
                          : 0u;
      }
    }
  });
  if (std::ranges::any_of(touches, [](std::uint32_t n) { return n != 0; })) mark_touching(grid, buffers);
  buffers[BufferId::near_position] = position;
  buffers[BufferId::near_velocity] = std::as_const(buffers)[BufferId::velocity];
  buffers.words_of(BufferId::surface_bound).assign(grid.count(), shared::kInfinity);
  buffers.words_of(BufferId::surface_sums).assign(std::size_t{shared::kSumPlanes} * grid.count(), 0);
}

}  // namespace

const Pass touch_weight = collision_pass(
    "touch_weight", "self-collision: weighs pairs nearer than their limit; keeps the state that contacts see",
    mirror<float>, mirror<double>, shared::kContactGroups);

}  // namespace weft
