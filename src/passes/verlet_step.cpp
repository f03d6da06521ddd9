// verlet_step: position Verlet as cloth demos teach it, x₊ = 2x − x₋ + acc·h². Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

/// docs/solvers.md "verlet". The velocity is what two positions say, (x₁ − x₀)/h: damping sees it, and the
/// closing half kick starts from it. The frame's first row has no previous position and takes h·v instead.
template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Substep<T> substep(context);
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  auto& previous = buffers[BufferId::position_previous];
  for (auto* out : {&position_next, &velocity_next, &previous}) out->resize(context.model.grid.count());
  const bool starts = context.row_index == 0;
  const T h = substep.row.drift, gain = substep.row.gain * h;
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> own(buffers, substep, p);
    Vec3<T> x1 = own.x, v = own.v, behind = own.x;
    if (!own.pinned()) {
      Vec3<T> travelled = starts ? h * own.v : own.x - xyz(previous[p]);
      if (substep.has_air) travelled = travelled - substep.row.loss * travelled;
      x1 = (own.x + travelled) + gain * substep.acceleration(force, own.w);
      v = (x1 - own.x) / h;
      if (substep.has_contact()) {
        const Vec3<T> free_x = x1, free_v = v;
        substep.touch(own.x, x1, v);
        if (x1 != free_x || v != free_v) behind = x1 - h * v;  // as if it had always moved so
      }
    }
    position_next[p] = glm::vec<4, T>(x1, own.relative);
    velocity_next[p] = glm::vec<4, T>(v, T(0));
    previous[p] = glm::vec<4, T>(behind, T(0));
  });
}

}  // namespace

const Pass verlet_step = spring_pass(
    "verlet_step", "springs, damping, bending, air, gravity, contact: one step of position Verlet",
    mirror<float>, mirror<double>);

}  // namespace weft
