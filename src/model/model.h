// The Model: everything immutable that follows from a Scene before time runs. Grid, masses, pins, spring
// kinds and the stable-step bound, exactly as docs/physics.md states them. Never changes after build().
#pragma once
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace weft {

/// The rectangular particle grid. Particle (i, j) has index j·nx + i; row 0 is the top edge. Several cloths
/// stand one below the other: the k-th has rows k·ny to (k + 1)·ny − 1, and nothing joins two of them.
struct Grid {
  std::uint32_t nx = 0, ny = 0;  ///< of one cloth
  double spacing_m = 0.0;        ///< a, the edge of a square cell
  std::uint32_t cloths = 1;
  std::uint32_t rows() const { return ny * cloths; }  ///< of all cloths
  std::uint32_t count() const { return nx * rows(); }
  std::uint32_t own_row(std::uint32_t row) const { return row % ny; }  ///< of a row's own cloth
  std::uint32_t index(std::uint32_t i, std::uint32_t j) const { return j * nx + i; }
  double width_m() const { return spacing_m * (nx - 1); }
  double height_m() const { return spacing_m * (ny - 1); }  ///< the real height
};

/// One family of springs: all joins of offset (di, dj). Coefficients are unweighted interior values.
struct SpringKind {
  int di, dj;            ///< (1,0) (0,1) (1,1) (−1,1) (2,0) (0,2)
  double stiffness_n_m;  ///< k
  double rest_m;
  double damping_n_s_m;     ///< c = min(beta·k, 2·zeta·sqrt(k·m0/2)), unweighted
  bool halves_on_boundary;  ///< weight ½ along a boundary line (structural, flex)
};
enum SpringName { kStructuralI, kStructuralJ, kShearDown, kShearUp, kFlexI, kFlexJ, kSpringKindCount };

/// lambda bounds the largest eigenvalue of M⁻¹K, gamma that of the spring damping, in any configuration.
struct StepBound {
  double lambda_1_s2 = 0.0;
  double gamma_1_s = 0.0;
};

/// A particle that a pin with keys, on a sphere or with a release holds.
struct MovedParticle {
  std::uint32_t particle;
  std::uint32_t pin;    ///< index in Model::moved_pins
  glm::dvec3 anchor_m;  ///< its place at the cloth's start, without the pin's offset
};

struct DistanceGrid;  // model/distance_grid.h

/// The pinned particle that is nearest on the flat cloth, and the farthest that a particle may be from it.
struct Tether {
  std::uint32_t anchor = 0;
  double reach_m = -1.0;  ///< below 0: none, the particle is pinned itself
};

struct Model {
  Scene scene;
  Grid grid;
  double interior_mass_kg = 0.0;              ///< m0 = rho·a²
  std::vector<double> relative_inverse_mass;  ///< m0/m: 1 inside, 2 edge, 4 corner, 0 pinned; shape [count]
  std::vector<double>
      released_inverse_mass;  ///< the same once every pin has let go that will; empty: none will
  std::array<SpringKind, kSpringKindCount> springs;  ///< kinds with k = 0 are absent
  /// kappa = B/a² of an interior line [N/m]: along i (the weft), along j (the warp).
  std::array<double, 2> bend_kappa_n_m{};
  double half_thickness_m = 0.0;          ///< of the cloth in contact; 0 without self-collision
  std::vector<std::uint32_t> moved_pins;  ///< that move or let go, as indices in scene.pins, ascending
  std::vector<MovedParticle>
      moved_particles;          ///< ascending; one of several pins is that which holds longest's
  std::vector<Tether> tethers;  ///< shape [count]; empty without [tethers]
  std::vector<std::shared_ptr<const DistanceGrid>> meshes;  ///< one of [[meshes]] each, in scene order
  std::uint64_t spring_count = 0;  ///< springs that exist and do not join two pinned particles
  StepBound bound;

  bool bends() const { return bend_kappa_n_m[0] > 0.0 || bend_kappa_n_m[1] > 0.0; }
  /// Whether weft and warp differ in stiffness or rigidity.
  bool anisotropic() const {
    return springs[kStructuralI].stiffness_n_m != springs[kStructuralJ].stiffness_n_m ||
           springs[kFlexI].stiffness_n_m != springs[kFlexJ].stiffness_n_m ||
           bend_kappa_n_m[0] != bend_kappa_n_m[1];
  }
  /// m0/m when no pin holds any more that lets go: what bounds must count with.
  double loosest_inverse_mass(std::uint32_t particle) const {
    return released_inverse_mass.empty() ? relative_inverse_mass[particle] : released_inverse_mass[particle];
  }
  /// m0/m at a time [s]; 0 while a pin holds the particle.
  double inverse_mass_at(std::uint32_t particle, double time_s) const;
  double inverse_mass(std::uint32_t particle) const {
    return relative_inverse_mass[particle] / interior_mass_kg;
  }
};

/// Positions [m] and velocities [m/s] at one instant, in particle order. Floats survive the round trip
/// exactly.
struct State {
  std::vector<glm::dvec3> position, velocity;
  double time_s = 0.0;
  std::vector<std::uint32_t> broken_links =
      {};  ///< bits of shared/links.h, shape [count]; empty: none broken
};

/// The grid of a scene's cloth: the grid rule of docs/physics.md.
Grid build_grid(const Scene& scene);

/// @throws Error(Exit::usage) when a pin holds no particle.
Model build_model(const Scene& scene);

/// For tests of extreme mass ratios only: the same model with every particle's inverse mass scaled.
Model with_mass_scale(const Model& model, std::span<const double> inverse_mass_scale);

/// Whether a pin has let go by a time [s].
bool has_released(const PinSection& pin, double time_s);

/// How far a pin is from its place at the start [m], and its velocity up to that moment [m/s].
glm::dvec3 pin_offset_at(const Scene& scene, const PinSection& pin, double time_s);
glm::dvec3 pin_velocity_before(const Scene& scene, const PinSection& pin, double time_s);

/// The scene's start: flat, at rest, with its imperfection; pins with keys where these are at time 0.
State start_state(const Model& model);

/// Puts what moving pins hold where these are at the state's time, with their velocity.
void place_moved_pins(const Model& model, State& state);

/// Wind velocity [m/s] at time t; zero without wind.
glm::dvec3 wind_at(const Scene& scene, double time_s);

/// A sphere's centre [m] at time t.
glm::dvec3 sphere_center_at(const SphereSection& sphere, double time_s);

}  // namespace weft
