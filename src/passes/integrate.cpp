// integrate: one substep in one pass. Declaration and CPU mirror; the shader is written apart from it.
#include "passes/integrate.h"

#include <algorithm>

#include "passes/contact.h"
#include "passes/parallel.h"
#include "passes/passes.h"

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
  return {{"shear", positive(m.springs[kShearDown].stiffness_n_m)},
          {"flex", positive(m.springs[kFlexI].stiffness_n_m)},
          {"bending", positive(m.bend_kappa_n_m)},
          {"damping", damping},
          {"air", air},
          {"wind", wind},
          {"gravity", gravity},
          {"floor", scene.floor.has_value()},
          {"spheres", !scene.spheres.empty()},
          {"pins", pins}};
}

namespace {

template <class T>
using Vec3 = glm::vec<3, T>;

template <class T>
Vec3<T> xyz(const glm::vec<4, T>& v) {
  return {v.x, v.y, v.z};
}

/// Copies rows of particles out of the buffers, component by component, into a ring of three.
template <class T>
class RowLoader {
 public:
  RowLoader(const HostBuffers<T>& buffers, std::size_t nx) : buffers_(buffers), nx_(nx), scratch_(18 * nx) {}

  RowPointers<T> operator()(std::size_t j) {
    T* const ring = scratch_.data() + (j % 3) * 6 * nx_;
    const glm::vec<4, T>* x = buffers_[BufferId::position].data() + j * nx_;
    const glm::vec<4, T>* v = buffers_[BufferId::velocity].data() + j * nx_;
    for (std::size_t i = 0; i < nx_; ++i) {
      ring[i] = x[i].x, ring[nx_ + i] = x[i].y, ring[2 * nx_ + i] = x[i].z;
      ring[3 * nx_ + i] = v[i].x, ring[4 * nx_ + i] = v[i].y, ring[5 * nx_ + i] = v[i].z;
    }
    return {ring, ring + nx_, ring + 2 * nx_, ring + 3 * nx_, ring + 4 * nx_, ring + 5 * nx_};
  }

 private:
  const HostBuffers<T>& buffers_;
  std::size_t nx_;
  std::vector<T> scratch_;
};

/// What one particle's kick, drift and contact read, in T.
template <class T>
struct Substep {
  SubstepRow<T> row;
  Vec3<T> gravity;
  T inverse_mass;  ///< of an interior particle [1/kg]
  FloorRow<T> ground{};
  bool has_air, has_wind, has_gravity, has_floor, has_spheres;

  explicit Substep(const MirrorContext& context)
      : row(substep_row<T>(context.model, context.row)),
        gravity(context.model.scene.gravity ? context.model.scene.gravity->acceleration_m_s2
                                            : glm::dvec3(0.0)),
        inverse_mass(static_cast<T>(1.0 / context.model.interior_mass_kg)),
        has_air(on(context, kHasAir)),
        has_wind(on(context, kHasWind)),
        has_gravity(on(context, kHasGravity)),
        has_floor(on(context, kHasFloor)),
        has_spheres(on(context, kHasSpheres)) {
    if (has_floor) ground = floor_row<T>(context.model);
  }

  static bool on(const MirrorContext& context, IntegrateConstant id) {
    return context.constants[id].value != 0;
  }

  /// docs/float-form.md "Kick and drift" and "Contact".
  void move(const Vec3<T>& force, T w, const Vec3<T>& x0, Vec3<T>& x1, Vec3<T>& v) const {
    Vec3<T> acceleration = force * w;
    if (has_gravity) acceleration = acceleration + gravity;
    if (has_wind) acceleration = acceleration + row.alpha_wind;
    v = has_air ? row.decay * v + row.gain * acceleration : v + row.gain * acceleration;
    x1 = x0 + row.drift * v;
    if (!(row.drift > T(0))) return;
    if (has_spheres)
      for (const SphereRow<T>& sphere : row.spheres) sphere_contact(sphere, x0, x1, v);
    if (has_floor) floor_contact(ground, x1, v);
  }
};

template <class T>
void integrate_band(const SweepTables<T>& tables, const Substep<T>& substep, std::size_t begin,
                    std::size_t end, HostBuffers<T>& buffers) {
  const std::size_t nx = tables.nx;
  const auto& position = std::as_const(buffers)[BufferId::position];
  const auto& velocity = std::as_const(buffers)[BufferId::velocity];
  auto& position_next = buffers[BufferId::position_next];
  auto& velocity_next = buffers[BufferId::velocity_next];
  ForceSweep<T> sweep(tables);
  sweep.run(begin, end, RowLoader<T>(buffers, nx), [&](std::size_t j, const std::array<T*, 3>& force) {
    for (std::size_t i = 0; i < nx; ++i) {
      const std::size_t p = j * nx + i;
      const Vec3<T> x0 = xyz(position[p]);
      Vec3<T> x1 = x0, v = xyz(velocity[p]);
      const T w = position[p].w * substep.inverse_mass;
      if (w != T(0)) substep.move({force[0][i], force[1][i], force[2][i]}, w, x0, x1, v);
      position_next[p] = glm::vec<4, T>(x1, position[p].w);
      velocity_next[p] = glm::vec<4, T>(v, T(0));
    }
  });
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const SweepTables<T> tables(grid, spring_rows<T>(context.model), force_effects(context.constants));
  const Substep<T> substep(context);
  buffers[BufferId::position_next].resize(grid.count());
  buffers[BufferId::velocity_next].resize(grid.count());
  parallel_rows(grid.ny, grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    integrate_band(tables, substep, begin, end, buffers);
  });
}

}  // namespace

const Pass integrate{
    .name = "integrate",
    .about = "springs, damping, bending, air, gravity, contact: one kick and drift",
    .domain =
        [](const Model& m) {
          return Range{m.grid.nx, m.grid.ny, 0, 0};
        },
    .constants = integrate_constants,
    .spring_evaluations = [](const Model& m) { return m.spring_count; },
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    // A reciprocal root that is off by 4 ulp moves a stiff substep by about 1e-6 of a cell; the velocity that
    // goes with it is that over the step, hence the absolute part.
    .tolerance = {.relative = 2e-6, .absolute = 5e-5},
    .swaps_state = true,
};

}  // namespace weft
