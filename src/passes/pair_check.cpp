// pair_check: does everyone still move in its own room? Do the lists hold, are contacts due? Declaration and
// CPU mirror.
#include "passes/leash.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  using V = glm::vec<3, T>;
  const CollisionView<T> view(context.model);
  bool stale = begin_check(context, view, buffers);
  auto& state = buffers.words_of(BufferId::collision_state);
  if (state[shared::kListsArmed] != 0) {
    buffers[BufferId::near_position].resize(view.grid.count());
    const Leash<T> leash(view, buffers);
    auto &position = buffers[BufferId::position], &velocity = buffers[BufferId::velocity];
    for (std::uint32_t p = 0; p < view.grid.count(); ++p) {
      const T w = position[p].w;
      V x(position[p]), v(velocity[p]);
      const V built(buffers[BufferId::built_position][p]);
      stale |= leash.is_stale(x, built);
      if (w == T(0)) continue;
      const std::uint32_t cuts = leash.keep(x, v, built, V(buffers[BufferId::near_position][p]),
                                            buffers.words_of(BufferId::surface_bound)[p]);
      if (cuts == 0) continue;
      state[shared::kHeldBack] += cuts;
      position[p] = glm::vec<4, T>(x, w);
      velocity[p] = glm::vec<4, T>(v, T(0));
    }
  }
  end_check(view, stale, buffers);
}

}  // namespace

const Pass pair_check{
    .name = "pair_check",
    .about = "self-collision: keeps motion in its room; do the lists still hold? empties the grid",
    .domain = collision_domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .marches = true,
    .takes_texels = true,
    .interval = contact_interval,
};

}  // namespace weft
