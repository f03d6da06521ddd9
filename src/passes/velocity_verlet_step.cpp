// velocity_verlet_step: completes a velocity-Verlet step at its end point and drifts into the next one, so
// that each substep evaluates every spring once. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

/// docs/solvers.md "velocity-verlet": `velocity` holds the prediction at the position's time, which damping
/// sees; half_velocity what the particle moves with, half a step behind. The frame's first row starts both
/// from the state.
template <class T, bool kCompensated>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  auto& half_velocity = buffers[BufferId::half_velocity];
  for (auto* out : {&position_next, &velocity_next, &half_velocity}) out->resize(context.model.grid.count());
  const bool starts = context.row_index == 0;
  Compensation<T, kCompensated> compensation(buffers, context.model.grid.count());
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> own(buffers, substep, p);
    Vec3<T> x1 = own.x, v = own.v, predicted = own.v;
    if (!own.pinned()) {
      const Vec3<T> acceleration = substep.acceleration(force, own.w);
      if (!starts) v = xyz(half_velocity[p]);
      kick_drift_touch(substep, compensation, p, acceleration, own.x, x1, v);
      predicted = v + substep.change(v, acceleration, substep.row.predict_loss, substep.row.predict_gain);
    }
    position_next[p] = glm::vec<4, T>(x1, own.relative);
    velocity_next[p] = glm::vec<4, T>(predicted, T(0));
    half_velocity[p] = glm::vec<4, T>(v, T(0));
  });
}

}  // namespace

const Pass velocity_verlet_step = spring_pass(
    "velocity_verlet_step", "springs, damping, bending, air, gravity, contact: one step of velocity Verlet",
    mirror<float, false>, mirror<double, false>, &velocity_verlet_compensated);

const Pass velocity_verlet_compensated =
    spring_pass("velocity_verlet_compensated",
                "springs, damping, bending, air, gravity, contact: one step of velocity Verlet, positions "
                "summed with compensation",
                mirror<float, true>, mirror<double, true>);

}  // namespace weft
