// xpbd_predict: how far every particle would move by itself, by gravity and air alone; the springs follow as
// constraints. Declaration and CPU mirror. Source: Macklin et al. 2019, Small Steps, algorithm 1, lines 5-7.
#include "passes/passes.h"
#include "passes/xpbd.h"

namespace weft {
namespace {

Constants constants(const Model& m) {
  const Constants all = integrate_constants(m);
  return {all[kHasAir], all[kHasWind], all[kHasGravity]};
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const Grid& grid = context.model.grid;
  auto& position_next = buffers[BufferId::position_next];
  position_next.resize(grid.count());
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      const Particle<T> own(buffers, substep, p);
      Vec3<T> moved(T(0));
      if (!own.pinned())
        moved = substep.row.drift * substep.kicked(own.v, substep.with_outside(Vec3<T>(T(0))));
      position_next[p] = glm::vec<4, T>(moved, own.relative);
    }
  });
}

}  // namespace

const Pass xpbd_predict{
    .name = "xpbd_predict",
    .about = "gravity and air: how far each particle would move by itself",
    .domain = whole_cloth,
    .constants = constants,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
