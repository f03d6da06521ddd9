// xpbd_finish: velocities from what the particles have moved, then contact. Declaration and CPU mirror.
// Source: Macklin et al. 2019, Small Steps, algorithm 1, line 14.
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/xpbd.h"

namespace weft {
namespace {

Constants constants(const Model& m) {
  const Constants all = integrate_constants(m);
  return {all[kHasFloor], all[kHasSpheres]};
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const Grid& grid = context.model.grid;
  auto& position_next = buffers[BufferId::position_next];  // how far each has moved
  auto& velocity_next = buffers[BufferId::velocity_next];
  velocity_next.resize(grid.count());
  ReachTeller<T> reach(context, buffers);
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      const Particle<T> own(buffers, substep, p);
      Vec3<T> x1 = own.x, v = own.v;
      if (own.relative != T(0)) {
        const Vec3<T> moved = xyz(position_next[p]);
        x1 = own.x + moved;
        v = moved / substep.row.drift;
        substep.touch(own.x, x1, v);
        reach.look(own.x, x1);
      }
      position_next[p] = glm::vec<4, T>(x1, own.relative);
      velocity_next[p] = glm::vec<4, T>(v, T(0));
    }
  });
}

}  // namespace

const Pass xpbd_finish{
    .name = "xpbd_finish",
    .about = "velocities from what the particles have moved, and contact",
    .domain = whole_cloth,
    .constants = constants,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .swaps_state = true,
    .tells_reach = true,
};

}  // namespace weft
