// rk4_middle: the second and the third stage. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/runge_kutta.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const T weight = substep.row.gain, reach = substep.row.drift;
  const StageOutputs<T> out(buffers, context.model);
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> stage(buffers, substep, p);
    Vec3<T> slope_x(T(0)), slope_v(T(0));
    if (!stage.pinned()) {
      slope_x = stage.v;
      slope_v = stage_acceleration(substep, stage, force);
    }
    put(out.sum_x, p, xyz(out.sum_x[p]) + weight * slope_x);
    put(out.sum_v, p, xyz(out.sum_v[p]) + weight * slope_v);
    put(out.next_x, p, xyz(out.base_x[p]) + reach * slope_x, stage.relative);
    put(out.next_v, p, xyz(out.base_v[p]) + reach * slope_v);
  });
}

}  // namespace

const Pass rk4_middle =
    spring_pass("rk4_middle", "the second and third stage of Runge-Kutta", mirror<float>, mirror<double>);

}  // namespace weft
