// touch_count: how many pairs of each particle are nearer than their limit. Declaration and CPU mirror.
#include <utility>

#include "passes/collision.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  const auto& position = std::as_const(buffers)[BufferId::position];
  const auto& counts = buffers.words_of(BufferId::pair_count);
  const auto& places = buffers.words_of(BufferId::pair_places);
  auto& touches = buffers.words_of(BufferId::touch_count);
  touches.resize(grid.count());
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      touches[p] = 0;
      for (std::size_t k = 0; k < counts[p]; ++k) {
        const std::uint32_t other = view.particle_at(places[k * position.size() + p]);
        touches[p] += squared_distance(position[p], position[other]) < view.limit(p, other).squared ? 1u : 0u;
      }
    }
  });
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kListGroups] = state[shared::kScanGroups] = 0;
}

}  // namespace

const Pass touch_count{
    .name = "touch_count",
    .about = "self-collision: pairs nearer than their limit",
    .domain = collision_domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .interval = contact_interval,
};

}  // namespace weft
