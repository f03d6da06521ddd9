// The bound on the mean square speed, fed by what moves and pulls.
#include "model/speed_budget.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/distance_grid.h"
#include "model/measures.h"
#include "model/motion.h"
#include "model/solids.h"
#include "model/springs.h"
#include "shared/watch.h"

namespace weft {
namespace {

/// Rounding, an imperfect start, a step's share of a contact: a cloth at rest in empty space may move so
/// fast.
constexpr double kAlways_m_s = 1.0;

/// How fast √(2E/M) can grow when a particle is moved at 1 m/s against all others [1/s]: two ends of each
/// spring, and four particles' worth of each bending triple.
double reaction_1_s(const Model& model) {
  const double mass_kg = free_mass_ratio(model) * model.interior_mass_kg;
  if (mass_kg == 0.0) return 0.0;
  double stiffness_n_m = 0.0;
  for_each_spring(model, [&](const SpringKind& kind, std::uint32_t, std::uint32_t, double weight) {
    stiffness_n_m += 4.0 * weight * kind.stiffness_n_m;
  });
  for_each_triple(model, [&](std::uint32_t, std::uint32_t, std::uint32_t, double kappa) {
    stiffness_n_m += 16.0 * kappa;
  });
  return std::sqrt(stiffness_n_m / mass_kg);
}

/// Speed [m/s] of the fastest collider or pin.
double mover_speed_m_s(const Scene& scene) {
  double fastest = 0.0;
  for (const SphereSection& sphere : scene.spheres)
    fastest =
        std::max(fastest, sphere.keys.empty() ? glm::length(sphere.velocity_m_s) : fastest_m_s(sphere.keys));
  for (const Solid& solid : solids_of(scene))
    fastest = std::max(fastest, fastest_m_s(*solid.section, extent_m(solid)));
  for (const MeshSection& mesh : scene.meshes)  // no mesh reaches farther from its origin
    fastest = std::max(fastest, fastest_m_s(mesh, kMeshFarthest_m));
  for (const PinSection& pin : scene.pins) fastest = std::max(fastest, fastest_m_s(pin.keys));
  return fastest;
}

/// By how much all of a stored energy can be more in the next model: its springs' stiffness, their largest
/// ratio, and what less mass makes of the same energy.
double energy_ratio(const Model& before, const Model& next) {
  double ratio = 1.0;
  for (std::size_t kind = 0; kind < kSpringKindCount; ++kind)
    if (before.springs[kind].stiffness_n_m > 0.0)
      ratio = std::max(ratio, next.springs[kind].stiffness_n_m / before.springs[kind].stiffness_n_m);
  for (std::size_t along = 0; along < 2; ++along)
    if (before.bend_kappa_n_m[along] > 0.0)
      ratio = std::max(ratio, next.bend_kappa_n_m[along] / before.bend_kappa_n_m[along]);
  return ratio * std::max(1.0, before.interior_mass_kg / next.interior_mass_kg);
}

/// How far the strain limit can pull a particle in: the most that a spring is beyond its limit, for as many
/// springs as lie in a row across the cloth.
double pulled_in_m(const Model& model, const State& start) {
  const double limit = model.scene.material.strain_limit;
  if (limit == 0.0) return 0.0;
  double most_m = 0.0;
  for_each_spring(model, [&](const SpringKind& kind, std::uint32_t a, std::uint32_t b, double) {
    if (kind.di == 2 || kind.dj == 2) return;  // flex springs are not limited
    const double length_m = glm::distance(start.position[a], start.position[b]);
    most_m = std::max(most_m, length_m - (1.0 + limit) * kind.rest_m);
  });
  return most_m * (model.grid.nx + model.grid.ny);
}

/// How far pins that move are from where they are put next: their keys may have changed meanwhile.
double pins_jump_m(const Model& model, const State& start) {
  State placed = start;
  place_moved_pins(model, placed);
  double most_m = 0.0;
  for (const MovedParticle& held : model.moved_particles)
    most_m = std::max(most_m, glm::distance(placed.position[held.particle], start.position[held.particle]));
  return most_m;
}

}  // namespace

double free_mass_ratio(const Model& model) {
  double sum = 0.0;
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    if (const double inverse = model.loosest_inverse_mass(p); inverse != 0.0) sum += 1.0 / inverse;
  return sum;
}

bool gives_by_place(const Model& before, const Model& next) {
  const Scene &was = before.scene, &is = next.scene;
  return next.relative_inverse_mass != before.relative_inverse_mass ||
         next.released_inverse_mass != before.released_inverse_mass ||
         next.half_thickness_m != before.half_thickness_m ||
         is.material.strain_limit != was.material.strain_limit || is.floor != was.floor ||
         is.pins != was.pins || is.spheres != was.spheres || is.capsules != was.capsules ||
         is.boxes != was.boxes || is.meshes != was.meshes;
}

SpeedBudget::SpeedBudget(const Model& model, const State& start, bool in_double)
    : given_m_s_(kAlways_m_s), reaction_1_s_(reaction_1_s(model)), rounding_(in_double ? 0x1p-53 : 0x1p-24) {
  for (const glm::dvec3& x : start.position) farthest_m_ = std::max(farthest_m_, glm::length(x));
  const double mass_kg = free_mass_ratio(model) * model.interior_mass_kg;
  if (mass_kg == 0.0) return;
  const Energy begins = energy(model, start);
  given_m_s_ += std::sqrt(2.0 * (begins.kinetic_j + begins.elastic_j + begins.bending_j) / mass_kg);
  // Contact moves what begins inside a collider, or inside the cloth itself, out of it at once.
  const double inside_m = deepest_penetration(model, start) + 2.0 * model.half_thickness_m;
  given_m_s_ += reaction_1_s_ * (inside_m + pulled_in_m(model, start) + pins_jump_m(model, start));
}

void SpeedBudget::elapse(const Scene& scene, double duration_s, std::uint32_t substeps, double hand_m_s) {
  const double mover_m_s = std::max(hand_m_s, mover_speed_m_s(scene));
  farthest_m_ += std::max(given_m_s_, mover_m_s) * duration_s;
  const double moved_m = mover_m_s * duration_s + rounding_ * farthest_m_ * substeps;
  given_m_s_ += 2.0 * std::max(0.0, mover_m_s - mover_m_s_) + reaction_1_s_ * moved_m;
  mover_m_s_ = std::max(mover_m_s_, mover_m_s);
  if (scene.gravity) given_m_s_ += glm::length(scene.gravity->acceleration_m_s2) * duration_s;
  if (!scene.wind) return;
  const double wind_m_s = glm::length(scene.wind->velocity_m_s) * (1.0 + std::abs(scene.wind->gust)) +
                          std::sqrt(3.0) * scene.wind->noise_m_s;
  if (scene.aerodynamics) {  // at up to twice the wind's speed, against it
    const AerodynamicsSection& air = *scene.aerodynamics;
    given_m_s_ += 2.0 * air.density_kg_m3 * (air.drag + air.lift) * wind_m_s * wind_m_s /
                  scene.material.density_kg_m2 * duration_s;
  }
  if (!scene.air) return;
  given_m_s_ += scene.air->drag_kg_m2_s / scene.material.density_kg_m2 * wind_m_s * duration_s;
}

void SpeedBudget::adopt(const Model& before, const Model& next) {
  given_m_s_ *= std::sqrt(energy_ratio(before, next));
  reaction_1_s_ = reaction_1_s(next);
}

double SpeedBudget::allowed_m_s() const { return kMargin * given_m_s_; }

double energy_share_s2_m2(double free_mass_ratio, double allowed_m_s) {
  const double whole = free_mass_ratio * allowed_m_s * allowed_m_s;
  return whole > 0.0 ? static_cast<double>(shared::kWatchWhole) / whole : 0.0;
}

}  // namespace weft
