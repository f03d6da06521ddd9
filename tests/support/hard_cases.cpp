// The starts, masses and hands of hard cases, and the measures of a run.
#include "support/hard_cases.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "model/carry.h"
#include "model/measures.h"
#include "scene/reader.h"
#include "support/hard_effects.h"
#include "support/hard_measures.h"

namespace weft::hard {
namespace {

glm::dvec3 random_vector(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double x = unit(random), y = unit(random), z = unit(random);
  return {x, y, z};
}

/// The scene's material at step k of a sweep: each of three parameters goes up and down over its decades, at
/// a pace of its own.
Scene swept(const Scene& scene, std::uint64_t k) {
  const auto wave = [&](double period) {
    return std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / period);
  };
  Scene next = scene;
  next.material.membrane_n_m = 1000.0 * std::pow(10.0, 1.5 * wave(97.0));
  next.material.bend_n_m = 2e-5 * std::pow(10.0, 1.5 * wave(61.0));
  next.material.damping_s = 1e-4 * std::pow(10.0, 2.0 * wave(37.0));
  return next;
}

/// The scene with the resolution of frame k: another one every ten frames.
Scene regridded(const Scene& scene, std::uint64_t k) {
  constexpr std::array<std::uint32_t, 6> kResolutions{16, 33, 7, 24, 5, 29};
  Scene next = scene;
  next.cloth.resolution = kResolutions[k / 10 % kResolutions.size()];
  return next;
}

/// Follows a run: what is most over all frames' ends.
class Watcher {
 public:
  Watcher(const Model& model, const State& start) : before_(start), start_j_(energy(model, start).total()) {
    const Energy begins = energy(model, start);
    const double gravity_m_s2 =
        model.scene.gravity ? glm::length(model.scene.gravity->acceleration_m_s2) : 0.0;
    double mass_kg = 0.0;
    for (const double inverse : model.relative_inverse_mass)
      if (inverse != 0.0) mass_kg += model.interior_mass_kg / inverse;
    outcome.energy_scale_j = begins.kinetic_j + begins.elastic_j + begins.bending_j +
                             mass_kg * gravity_m_s2 * std::hypot(model.grid.width_m(), model.grid.height_m());
    momentum_ = linear_momentum(model, start);
    mass_kg_ = mass_kg;
  }
  /// A frame's end.
  void see(const Model& model, const State& state) {
    outcome.max_stretch = std::max(outcome.max_stretch, stretch(model, state).maximum);
    outcome.inside = std::max(outcome.inside, deepest_share(model, state));
    outcome.tunnelled += passed_through(model, before_, state);
    if (outcome.energy_scale_j > 0.0)
      outcome.energy_gain =
          std::max(outcome.energy_gain, (energy(model, state).total() - start_j_) / outcome.energy_scale_j);
    for (const glm::dvec3& v : state.velocity) fastest_m_s_ = std::max(fastest_m_s_, glm::length(v));
    if (fastest_m_s_ > 0.0)
      outcome.momentum_drift =
          std::max(outcome.momentum_drift,
                   glm::distance(linear_momentum(model, state), momentum_) / (mass_kg_ * fastest_m_s_));
    before_ = state;
  }
  /// A cloth carried over to another grid: what interpolating costs or gives is not the solver's.
  void carried(const Model& from, const State& before, const Model& to, const State& after) {
    start_j_ += energy(to, after).total() - energy(from, before).total();
    before_ = after;
  }
  Outcome outcome;

 private:
  State before_;
  double start_j_, mass_kg_ = 0.0, fastest_m_s_ = 0.0;
  glm::dvec3 momentum_{};
};

/// What the hand does before frame `k`; may put another simulation in place.
void use_hand(const HardCase& c, const Solver& solver, const MakeSimulation& make, std::uint64_t k,
              Watcher& watcher, std::unique_ptr<Simulation>& simulation) {
  if (c.hand == Hand::none) return;
  const Model& model = simulation->model();
  const bool sweeps = c.hand != Hand::changes_resolution;
  const Scene scene = c.hand == Hand::sweeps_parameters ? swept(model.scene, k)
                      : c.hand == Hand::sweeps_effect   ? with_swept_effect(model.scene, c.effect, k)
                                                        : regridded(model.scene, k);
  if (!sweeps && scene.cloth.resolution == model.scene.cloth.resolution) return;
  auto next = make(build_model(scene), solver);
  const State before = simulation->read(), after = carry_state(model, before, next->model());
  next->write(after);
  if (!sweeps) watcher.carried(model, before, next->model(), after);
  simulation = std::move(next);
}

}  // namespace

Model hard_model(const HardCase& c, std::span<const std::string> more) {
  SceneOverrides overrides;
  overrides.set = c.set;
  overrides.set.insert(overrides.set.end(), more.begin(), more.end());
  Scene scene = load_scene(WEFT_SOURCE_DIR "/tests/hard_cases/" + c.scene + ".toml", overrides).scene;
  if (!c.effect.empty()) scene = above_effect(std::move(scene), c.effect);
  const Model model = build_model(scene);
  if (c.masses == Masses::scene) return model;
  std::vector<double> scale(model.grid.count(), 1.0);
  const std::uint32_t middle = model.grid.index(model.grid.nx / 2, model.grid.ny / 2);
  if (c.masses == Masses::one_heavy) scale[middle] = 1.0 / c.mass_ratio;
  if (c.masses == Masses::one_light) scale[middle] = c.mass_ratio;
  if (c.masses == Masses::checkered)
    for (std::uint32_t p = 0; p < model.grid.count(); ++p)
      if ((p % model.grid.nx + p / model.grid.nx) % 2 == 0) scale[p] = 1.0 / c.mass_ratio;
  return with_mass_scale(model, scale);
}

std::string what_solver_lacks(const HardCase& c, const Solver& solver) {
  const Model model = hard_model(c);
  const std::string at_start = what_solver_lacks(model, solver);
  if (!at_start.empty() || c.hand != Hand::sweeps_effect) return at_start;
  return what_solver_lacks(build_model(with_swept_effect(model.scene, c.effect, 1)), solver);
}

State hard_start(const HardCase& c, const Model& model) {
  State state = start_state(model);
  const glm::dvec3 center = model.scene.cloth.center_m;
  std::mt19937_64 random(20261122);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
    glm::dvec3& x = state.position[p];
    const std::uint32_t i = p % model.grid.nx;
    if (c.start == Start::point) x = center;
    if (c.start == Start::speck) x = center + 1e-5 * random_vector(random);
    if (c.start == Start::line) x.x = center.x;
    if (c.start == Start::box) x = center + 0.5 * model.grid.width_m() * random_vector(random);
    if (c.start == Start::inside_out && (i ^ 1u) < model.grid.nx)
      x.x += ((i & 1u) == 0 ? 1.0 : -1.0) * model.grid.spacing_m;
    if (c.start == Start::falling_30 && model.relative_inverse_mass[p] != 0.0)
      state.velocity[p] = {0.0, -30.0, 0.0};
    if (c.start == Start::swinging) state.velocity[p] = 2.0 * random_vector(random);
  }
  return state;
}

Outcome run_hard_case(const HardCase& c, const Solver& solver, const MakeSimulation& make) {
  const Model model = hard_model(c);
  const State start = hard_start(c, model);
  std::unique_ptr<Simulation> simulation = make(model, solver);
  simulation->write(start);
  Watcher watcher(model, simulation->read());
  const double frame_s = model.scene.solver.frame_s;
  const std::uint64_t count = frames_for(c.time_s, frame_s, 1).whole;
  const auto began = std::chrono::steady_clock::now();
  for (std::uint64_t k = 0; k < count; ++k) {
    use_hand(c, solver, make, k, watcher, simulation);
    watcher.outcome.substeps = std::max(watcher.outcome.substeps, simulation->plan().substeps);
    simulation->advance(frame_s, simulation->plan().substeps);
    const State state = simulation->read();
    watcher.outcome.divergence = simulation->divergence();
    if (watcher.outcome.divergence) break;
    watcher.see(simulation->model(), state);
  }
  Outcome outcome = std::move(watcher.outcome);
  outcome.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (outcome.divergence)
    outcome.cause = likely_cause(*outcome.divergence, simulation->model(), simulation->plan());
  outcome.model = simulation->model();
  outcome.end = simulation->last_good().value_or(start);
  return outcome;
}

}  // namespace weft::hard
