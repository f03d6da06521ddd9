// integrate: one substep in one pass. Declaration and CPU mirror; the shader is written apart from it.
#include "passes/integrate.h"

#include <algorithm>

#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/spread.h"
#include "passes/substep.h"

namespace weft {

Constants integrate_constants(const Model& m) {
  const auto positive = [](double value) { return value > 0.0 ? 1u : 0u; };
  const Scene& scene = m.scene;
  const bool air = drag_rate(m) > 0.0;
  const bool wind = air && scene.wind && scene.wind->velocity_m_s != glm::dvec3(0.0);
  const bool gravity = scene.gravity && scene.gravity->acceleration_m_s2 != glm::dvec3(0.0);
  const bool pins = std::ranges::any_of(m.relative_inverse_mass, [](double w) { return w == 0.0; });
  const bool damping =
      std::ranges::any_of(m.springs, [](const SpringKind& kind) { return kind.damping_n_s_m > 0.0; });
  const std::array<std::uint32_t, kIntegrateConstantCount> values{
      positive(m.springs[kShearDown].stiffness_n_m),
      positive(std::max(m.springs[kFlexI].stiffness_n_m, m.springs[kFlexJ].stiffness_n_m)),
      m.bends(),
      damping,
      air,
      wind,
      gravity,
      scene.floor && scene.floor->is_level(),
      static_cast<std::uint32_t>(std::min<std::size_t>(scene.spheres.size(), kSpheresLooped)),
      pins};
  Constants constants;
  for (std::size_t id = 0; id < values.size(); ++id)
    constants.push_back({kIntegrateConstantNames[id], values[id]});
  return constants;
}

namespace {

template <class T, bool kCompensated>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (is_torn(context.model, buffers)) return;
  const Substep<T> substep(context);
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  position_next.resize(context.model.grid.count());
  velocity_next.resize(context.model.grid.count());
  ReachTeller<T> reach(context, buffers);
  SpreadTeller<T> spread(buffers, substep.row.drift, substep.has_contact());
  reach.look_at_links(context.model.grid, std::as_const(buffers)[BufferId::position]);
  Compensation<T, kCompensated> compensation(buffers, context.model.grid.count());
  sweep_particles(context, std::as_const(buffers), [&](std::size_t p, const Vec3<T>& force) {
    const Particle<T> own(buffers, substep, p);
    Vec3<T> x1 = own.x, v = own.v;
    if (!own.pinned()) {
      kick_drift_touch(substep, compensation, p, substep.acceleration(force, own.w), own.x, x1, v);
      reach.look(own.x, x1);
      spread.look(own.x, own.v, x1, v);
    }
    position_next[p] = glm::vec<4, T>(x1, own.relative);
    velocity_next[p] = glm::vec<4, T>(v, T(0));
  });
}

constexpr Pass telling(Pass pass, const Pass& once_torn) {
  pass.tells_reach = pass.sees_links = true;
  pass.once_torn = &once_torn;
  return pass;
}

}  // namespace

const Pass integrate =
    telling(spring_pass("integrate", "springs, damping, bending, air, gravity, contact: one kick and drift",
                        mirror<float, false>, mirror<double, false>, &integrate_compensated),
            integrate_torn);

const Pass integrate_compensated =
    telling(spring_pass("integrate_compensated",
                        "springs, damping, bending, air, gravity, contact: one kick "
                        "and drift, positions summed with compensation",
                        mirror<float, true>, mirror<double, true>),
            integrate_torn_compensated);

}  // namespace weft
