// What the mirrors of the explicit passes share: rows of particles out of the buffers, the force on each, and
// one particle's acceleration, kick and contact, operation by operation as docs/float-form.md.
#pragma once
#include <utility>
#include <vector>

#include "passes/contact.h"
#include "passes/integrate.h"
#include "passes/parallel.h"

namespace weft {

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
  /// @param first  row of the buffers that is row 0
  RowLoader(const HostBuffers<T>& buffers, std::size_t nx, std::size_t first)
      : buffers_(buffers), nx_(nx), first_(first), scratch_(18 * nx) {}

  RowPointers<T> operator()(std::size_t j) {
    T* const ring = scratch_.data() + (j % 3) * 6 * nx_;
    const glm::vec<4, T>* x = buffers_[BufferId::position].data() + (first_ + j) * nx_;
    const glm::vec<4, T>* v = buffers_[BufferId::velocity].data() + (first_ + j) * nx_;
    for (std::size_t i = 0; i < nx_; ++i) {
      ring[i] = x[i].x, ring[nx_ + i] = x[i].y, ring[2 * nx_ + i] = x[i].z;
      ring[3 * nx_ + i] = v[i].x, ring[4 * nx_ + i] = v[i].y, ring[5 * nx_ + i] = v[i].z;
    }
    return {ring, ring + nx_, ring + 2 * nx_, ring + 3 * nx_, ring + 4 * nx_, ring + 5 * nx_};
  }

 private:
  const HostBuffers<T>& buffers_;
  std::size_t nx_, first_;
  std::vector<T> scratch_;
};

/// What one particle's acceleration, kick and contact read, in T. An effect that the context's
/// constants do not name is absent.
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
    const std::string_view name = kIntegrateConstantNames[id];
    for (const Constant& constant : context.constants)
      if (constant.name == name) return constant.value != 0;
    return false;  // the pass does not have this effect
  }

  /// Of springs, gravity and wind, without the air's drag [m/s²]; w: inverse mass [1/kg].
  Vec3<T> acceleration(const Vec3<T>& force, T w) const { return with_outside(force * w); }

  /// `acceleration` and what acts from outside on every particle alike.
  Vec3<T> with_outside(Vec3<T> acceleration) const {
    if (has_gravity) acceleration = acceleration + gravity;
    if (has_wind) acceleration = acceleration + row.alpha_wind;
    return acceleration;
  }

  /// What a kick adds to v, with the row's loss and gain or another pair.
  Vec3<T> change(const Vec3<T>& v, const Vec3<T>& acceleration, T loss, T gain) const {
    return has_air ? gain * acceleration - loss * v : gain * acceleration;
  }
  Vec3<T> change(const Vec3<T>& v, const Vec3<T>& acceleration) const {
    return change(v, acceleration, row.loss, row.gain);
  }

  /// docs/float-form.md "Kick and drift".
  Vec3<T> kicked(const Vec3<T>& v, const Vec3<T>& acceleration) const { return v + change(v, acceleration); }

  bool has_contact() const { return has_spheres || has_floor; }

  /// docs/float-form.md "Contact", after a drift from x0 to x1.
  void touch(const Vec3<T>& x0, Vec3<T>& x1, Vec3<T>& v) const {
    if (has_spheres)
      for (const SphereRow<T>& sphere : row.spheres) sphere_contact(sphere, x0, x1, v);
    if (has_floor) floor_contact(ground, x1, v);
  }
};

/// Calls move(p, force [N]) for every particle, with the springs' force at `position` and `velocity`.
/// Several threads call it, each for particles of its own.
template <class T, class Move>
void sweep_particles(const MirrorContext& context, const HostBuffers<T>& buffers, Move&& move) {
  const Grid& grid = context.model.grid;
  const SweepTables<T> tables(grid, spring_rows<T>(context.model), force_effects(context.constants));
  const std::size_t nx = grid.nx;
  parallel_rows(grid.rows(), nx, [&](std::uint32_t begin, std::uint32_t end) {
    ForceSweep<T> sweep(tables);
    for (std::uint32_t row = begin; row < end;) {  // what of the band lies on one cloth
      const std::uint32_t first = row - grid.own_row(row), until = std::min(end, first + grid.ny);
      sweep.run(row - first, until - first, RowLoader<T>(buffers, nx, first),
                [&](std::size_t j, const std::array<T*, 3>& force) {
                  for (std::size_t i = 0; i < nx; ++i)
                    move((first + j) * nx + i, Vec3<T>(force[0][i], force[1][i], force[2][i]));
                });
      row = until;
    }
  });
}

/// One particle of the explicit passes' mirrors: where it starts, what it weighs.
template <class T>
struct Particle {
  Vec3<T> x, v;
  T relative, w;  ///< inverse mass, relative to an interior particle's and in 1/kg
  Particle(const HostBuffers<T>& buffers, const Substep<T>& substep, std::size_t p)
      : x(xyz(buffers[BufferId::position][p])),
        v(xyz(buffers[BufferId::velocity][p])),
        relative(buffers[BufferId::position][p].w),
        w(relative * substep.inverse_mass) {}
  bool pinned() const { return w == T(0); }
};

/// Where sums keep what rounding has added to positions and velocities; without compensation it is nothing
/// and costs nothing. docs/solvers.md "f32k".
template <class T, bool kCompensated>
class Compensation {
 public:
  Compensation(HostBuffers<T>& buffers, std::size_t count)
      : excess_(buffers[BufferId::compensation]), count_(count) {
    if (kCompensated) excess_.resize(2 * count, glm::vec<4, T>(T(0)));
  }
  Vec3<T> kicked(std::size_t p, const Vec3<T>& v, const Vec3<T>& change) {
    return added(count_ + p, v, change);
  }
  Vec3<T> drifted(std::size_t p, const Vec3<T>& x, const Vec3<T>& travel) { return added(p, x, travel); }
  /// Contact has put the particle somewhere else: nothing is left over.
  void forget(std::size_t p) {
    if (kCompensated) excess_[p] = excess_[count_ + p] = glm::vec<4, T>(T(0));
  }

 private:
  /// Kahan's sum.
  Vec3<T> added(std::size_t slot, const Vec3<T>& a, const Vec3<T>& b) {
    if constexpr (!kCompensated) return a + b;
    const Vec3<T> wanted = b - xyz(excess_[slot]);
    const Vec3<T> sum = a + wanted;
    excess_[slot] = glm::vec<4, T>((sum - a) - wanted, T(0));
    return sum;
  }
  std::vector<glm::vec<4, T>>& excess_;
  std::size_t count_;
};

/// docs/float-form.md "Kick and drift" of particle p from x0 with v, then contact; x1 and v are what comes of
/// it.
template <class T, bool kCompensated>
void kick_drift_touch(const Substep<T>& substep, Compensation<T, kCompensated>& compensation, std::size_t p,
                      const Vec3<T>& acceleration, const Vec3<T>& x0, Vec3<T>& x1, Vec3<T>& v) {
  v = compensation.kicked(p, v, substep.change(v, acceleration));
  x1 = compensation.drifted(p, x0, substep.row.drift * v);
  const Vec3<T> free_x = x1, free_v = v;
  if (substep.row.drift > T(0)) substep.touch(x0, x1, v);
  if (x1 != free_x || v != free_v) compensation.forget(p);
}

/// What a pass that evaluates the cloth's springs once a dispatch declares.
inline std::uint64_t every_spring(const Model& m) { return m.spring_count; }

/// A pass that evaluates every spring once a dispatch, marching down the rows into the other half of the
/// ping-pong, with the constants of `integrate`.
constexpr Pass spring_pass(std::string_view name, std::string_view about,
                           decltype(Pass::mirror_f32) mirror_f32, decltype(Pass::mirror_f64) mirror_f64) {
  return {.name = name,
          .about = about,
          .domain = whole_cloth,
          .constants = integrate_constants,
          .spring_evaluations = every_spring,
          .mirror_f32 = mirror_f32,
          .mirror_f64 = mirror_f64,
          .swaps_state = true,
          .marches = true};
}

/// The same with a form that compensates positions (f32k).
constexpr Pass spring_pass(std::string_view name, std::string_view about,
                           decltype(Pass::mirror_f32) mirror_f32, decltype(Pass::mirror_f64) mirror_f64,
                           const Pass* compensated) {
  Pass pass = spring_pass(name, about, mirror_f32, mirror_f64);
  pass.compensated = compensated;
  return pass;
}

}  // namespace weft
