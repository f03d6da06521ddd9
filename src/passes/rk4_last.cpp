// rk4_last: the last stage, the step and contact. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/runge_kutta.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  const T weight = substep.row.gain;
  const auto [next_x, next_v, base_x, base_v, sum_x, sum_v] =
      outputs<T, 6>(buffers, context.model,
                    {BufferId::position_next, BufferId::velocity_next, BufferId::base_position,
                     BufferId::base_velocity, BufferId::sum_position, BufferId::sum_velocity});
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> stage(buffers, substep, p);
    const Vec3<T> x0 = xyz((*base_x)[p]), v0 = xyz((*base_v)[p]);
    Vec3<T> x1 = x0, v1 = v0;
    if (!stage.pinned()) {
      x1 = x0 + (xyz((*sum_x)[p]) + weight * stage.v);
      v1 = v0 + (xyz((*sum_v)[p]) + weight * stage_acceleration(substep, stage, force));
      substep.touch(x0, x1, v1);
    }
    put(*next_x, p, x1, stage.relative);
    put(*next_v, p, v1);
  });
}

}  // namespace

const Pass rk4_last{
    .name = "rk4_last",
    .about = "the last stage of Runge-Kutta, the step and contact",
    .domain = whole_cloth,
    .constants = integrate_constants,
    .spring_evaluations = every_spring,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .swaps_state = true,
    .marches = true,
};

}  // namespace weft
