// rk4_middle: the second and the third stage. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/runge_kutta.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const T weight = substep.row.gain, reach = substep.row.drift;
  const auto [next_x, next_v, base_x, base_v, sum_x, sum_v] =
      outputs<T, 6>(buffers, context.model,
                    {BufferId::position_next, BufferId::velocity_next, BufferId::base_position,
                     BufferId::base_velocity, BufferId::sum_position, BufferId::sum_velocity});
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> stage(buffers, substep, p);
    Vec3<T> slope_x(T(0)), slope_v(T(0));
    if (!stage.pinned()) {
      slope_x = stage.v;
      slope_v = stage_acceleration(substep, stage, force);
    }
    put(*sum_x, p, xyz((*sum_x)[p]) + weight * slope_x);
    put(*sum_v, p, xyz((*sum_v)[p]) + weight * slope_v);
    put(*next_x, p, xyz((*base_x)[p]) + reach * slope_x, stage.relative);
    put(*next_v, p, xyz((*base_v)[p]) + reach * slope_v);
  });
}

}  // namespace

const Pass rk4_middle{
    .name = "rk4_middle",
    .about = "the second and third stage of Runge-Kutta",
    .domain = whole_cloth,
    .constants = integrate_constants,
    .spring_evaluations = every_spring,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .swaps_state = true,
    .marches = true,
};

}  // namespace weft
