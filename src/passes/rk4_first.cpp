// rk4_first: the first stage: keeps the base, begins the sum. Declaration and CPU mirror.
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
    const Particle<T> own(buffers, substep, p);
    Vec3<T> slope_x(T(0)), slope_v(T(0));
    if (!own.pinned()) {
      slope_x = own.v;
      slope_v = stage_acceleration(substep, own, force);
    }
    put(out.base_x, p, own.x);
    put(out.base_v, p, own.v);
    put(out.sum_x, p, weight * slope_x);
    put(out.sum_v, p, weight * slope_v);
    put(out.next_x, p, own.x + reach * slope_x, own.relative);
    put(out.next_v, p, own.v + reach * slope_v);
  });
}

}  // namespace

const Pass rk4_first =
    spring_pass("rk4_first", "the first stage of Runge-Kutta: keeps the step's start, begins the sum",
                mirror<float>, mirror<double>);

}  // namespace weft
