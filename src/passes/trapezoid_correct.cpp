// trapezoid_correct: the step with the mean of both slopes. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/runge_kutta.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const T weight = substep.row.gain;
  auto& next_x = output(buffers, context.model, BufferId::position_next);
  auto& next_v = output(buffers, context.model, BufferId::velocity_next);
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> far(buffers, substep, p);
    const Vec3<T> x0 = xyz(next_x[p]), v0 = xyz(next_v[p]);  // where the step began
    Vec3<T> x1 = x0, v1 = v0;
    if (!far.pinned()) {
      const Vec3<T> sum = v0 + far.v;
      x1 = x0 + weight * sum;
      v1 = T(0.5) * sum + weight * stage_acceleration(substep, far, force);
      substep.touch(x0, x1, v1);
    }
    put(next_x, p, x1, far.relative);
    put(next_v, p, v1);
  });
}

}  // namespace

const Pass trapezoid_correct = spring_pass(
    "trapezoid_correct", "the step with the mean of both slopes, and contact", mirror<float>, mirror<double>);

}  // namespace weft
