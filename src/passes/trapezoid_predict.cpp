// trapezoid_predict: an Euler step to the trapezoid's far end. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/runge_kutta.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const T weight = substep.row.gain, reach = substep.row.drift;
  auto& next_x = output(buffers, context.model, BufferId::position_next);
  auto& next_v = output(buffers, context.model, BufferId::velocity_next);
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> own(buffers, substep, p);
    Vec3<T> x1 = own.x, v1 = own.v;
    if (!own.pinned()) {
      x1 = own.x + reach * own.v;
      v1 = own.v + weight * stage_acceleration(substep, own, force);
    }
    put(next_x, p, x1, own.relative);
    put(next_v, p, v1);
  });
}

}  // namespace

const Pass trapezoid_predict =
    spring_pass("trapezoid_predict", "an Euler step, whose end is where the second slope is taken",
                mirror<float>, mirror<double>);

}  // namespace weft
