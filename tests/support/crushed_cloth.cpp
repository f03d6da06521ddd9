// Crushing a cloth, and running it.
#include "support/crushed_cloth.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <random>

#include "model/measures.h"
#include "sim/simulation.h"

namespace weft::hard {
namespace {

constexpr std::uint32_t kCrushFrames = 20, kCrushSubsteps = 500;  // a frame, at the automatic step
constexpr double kAutomaticShare = 0.9;                           // of the largest stable step

}  // namespace

Crush run_crushed(const Crushed& crushed) {
  Scene scene;
  scene.cloth.resolution = crushed.columns;
  scene.cloth.width_m = 0.1 * (crushed.columns - 1);
  scene.cloth.height_m = 1.1;
  scene.material.damping_s = crushed.damping_ratio > 0.0 ? 10.0 : 0.0;
  scene.material.damping_ratio_max = crushed.damping_ratio;
  if (!crushed.sheared) scene.material.shear_n_m = 0.0;
  const Model model = build_model(scene);
  const double step_s = kAutomaticShare * find_solver("leapfrog").step_max_s(model.bound);
  const auto substeps =
      static_cast<std::uint32_t>(std::lround(kCrushSubsteps * kAutomaticShare / crushed.step_share));
  State state = start_state(model);
  std::mt19937_64 random(20261122);
  std::normal_distribution<double> normal(0.0, crushed.off_cells * model.grid.spacing_m / std::sqrt(3.0));
  for (glm::dvec3& x : state.position) {
    const double dx = normal(random), dy = normal(random), dz = normal(random);
    x += glm::dvec3(dx, dy, dz);
  }
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f64");
  simulation->write(state);
  const double start_j = energy(model, state).total();
  Crush result;
  for (std::uint32_t f = 0; f < kCrushFrames; ++f) {
    simulation->advance(kCrushSubsteps * step_s, substeps);
    result.most_energy = std::max(result.most_energy, energy(model, simulation->read()).total() / start_j);
    if (simulation->divergence() && result.cause.empty())
      result.cause = likely_cause(*simulation->divergence(), model, simulation->plan());
  }
  return result;
}

}  // namespace weft::hard
