// rk4_last: the last stage, the step and contact. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/runge_kutta.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const T weight = substep.row.gain;
  const StageOutputs<T> out(buffers, context.model);
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> stage(buffers, substep, p);
    const Vec3<T> x0 = xyz(out.base_x[p]), v0 = xyz(out.base_v[p]);
    Vec3<T> x1 = x0, v1 = v0;
    if (!stage.pinned()) {
      x1 = x0 + (xyz(out.sum_x[p]) + weight * stage.v);
      v1 = v0 + (xyz(out.sum_v[p]) + weight * stage_acceleration(substep, stage, force));
      substep.touch(x0, x1, v1);
    }
    put(out.next_x, p, x1, stage.relative);
    put(out.next_v, p, v1);
  });
}

}  // namespace

const Pass rk4_last = spring_pass("rk4_last", "the last stage of Runge-Kutta, the step and contact",
                                  mirror<float>, mirror<double>);

}  // namespace weft
