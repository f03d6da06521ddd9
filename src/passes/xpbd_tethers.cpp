// xpbd_tethers: what is farther from its nearest pin than the cloth is long is brought back. Declaration and
// CPU mirror. Source: Kim, Chentanez and Mueller 2012, Long Range Attachments, section 3.
#include "passes/passes.h"
#include "passes/xpbd.h"

namespace weft {
namespace {

Range domain(const Model& m) { return m.tethers.empty() ? Range{} : whole_cloth(m); }

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const auto& start = std::as_const(buffers)[BufferId::position];
  auto& moved = buffers[BufferId::position_next];
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      const Tether& tether = context.model.tethers[p];
      const T reach = static_cast<T>(tether.reach_m);
      if (start[p].w == T(0) || reach < T(0)) continue;
      const Vec3<T> began = xyz(start[p]) - xyz(start[tether.anchor]);
      const Vec3<T> d = began + (xyz(moved[p]) - xyz(moved[tether.anchor]));
      const T q = dot3(d, d);
      if (!(q > reach * reach)) continue;
      const T l = std::sqrt(q);
      const Vec3<T> push = ((l - reach) * (T(1) / l)) * d;
      moved[p] = glm::vec<4, T>(xyz(moved[p]) - push, moved[p].w);
    }
  });
}

}  // namespace

const Pass xpbd_tethers{
    .name = "xpbd_tethers",
    .about = "brings back what is farther from its pin than the cloth is long",
    .domain = domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
