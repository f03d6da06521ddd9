// euler: explicit Euler in one pass: the position drifts with the old velocity. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  position_next.resize(context.model.grid.count());
  velocity_next.resize(context.model.grid.count());
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> own(buffers, substep, p);
    Vec3<T> x1 = own.x, v = own.v;
    if (!own.pinned()) {
      x1 = own.x + substep.row.drift * own.v;
      v = substep.kicked(own.v, substep.acceleration(force, own.w));
      substep.touch(own.x, x1, v);
    }
    position_next[p] = glm::vec<4, T>(x1, own.relative);
    velocity_next[p] = glm::vec<4, T>(v, T(0));
  });
}

}  // namespace

const Pass euler_step =
    spring_pass("euler_step", "springs, damping, bending, air, gravity, contact: one step of explicit Euler",
                mirror<float>, mirror<double>);

}  // namespace weft
