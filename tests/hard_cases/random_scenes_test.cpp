// Any scene that the reader takes stays finite: every number drawn log-uniformly from its whole allowed
// range, as the parameter table has it, with the work of a run capped. WEFT_PROPERTY_SCENES=100000 draws more
// than the 1000 of the quick tests; RapidCheck prints what repeats a failure and makes the scene simpler
// first.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "model/springs.h"
#include "scene/parameters.h"
#include "scene/reader.h"
#include "sim/simulation.h"

namespace weft::hard {
namespace {

constexpr std::uint32_t kFrames = 2, kSubstepsMost = 100;  // 200 substeps at most
constexpr std::uint32_t kResolutionMost = 32;
/// Leapfrog conserves a neighbour of the energy, which near its largest step swings about it.
constexpr double kEnergyShare = 0.25;

/// From low to high, both included; RapidCheck's own ranges begin small and grow with the test.
int whole(int low, int high) { return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high + 1)); }

double uniform(double low, double high) {
  constexpr int kSteps = 1'000'000;
  return low + (high - low) * whole(0, kSteps) / kSteps;
}

double log_uniform(double low, double high) { return low * std::pow(high / low, uniform(0.0, 1.0)); }

bool chance(double share) { return uniform(0.0, 1.0) > 1.0 - share; }

/// A number from a parameter's whole range: over nine decades where the range begins at 0, and on both sides
/// of it where it has two.
double number(const Parameter& parameter) {
  const double most = parameter.maximum;
  if (parameter.minimum > 0.0) return log_uniform(parameter.minimum, most);
  if (chance(0.15)) return 0.0;
  const double size = log_uniform(1e-9 * most, most);
  return parameter.minimum < 0.0 && chance(0.5) ? -size : size;
}

std::string line(std::string_view section, std::string_view key) {
  const Parameter& parameter = *find_parameter(section, key);
  if (parameter.kind == ParameterKind::vec3)
    return fmt::format("{} = [{:.9e}, {:.9e}, {:.9e}]\n", key, number(parameter), number(parameter),
                       number(parameter));
  return fmt::format("{} = {:.9e}\n", key, number(parameter));
}

/// The cloth and its pins, which depend on one another; returns the cell [m].
double draw_cloth(std::string& text) {
  const Parameter& width = *find_parameter("cloth", "width");
  const auto resolution = static_cast<std::uint32_t>(std::lround(log_uniform(4.0, kResolutionMost)));
  const double cell_m = log_uniform(width.minimum, width.maximum / 31.0);
  const double rows = std::round(log_uniform(3.0, kResolutionMost - 1.0));
  text += fmt::format("[cloth]\nresolution = {}\nwidth = {:.9e}\nheight = {:.9e}\n", resolution,
                      cell_m * (resolution - 1), cell_m * rows);
  text += line("cloth", "center");
  // Farther than a cell, the start strains springs to several times their length, and where particles fly
  // over a whole spring in one substep no bound on the step holds (docs/stability.md).
  text += fmt::format("imperfection = {:.9e}\n", log_uniform(1e-9, 1.0) * std::min(1.0, cell_m));
  if (chance(0.5)) text += "orientation = \"horizontal\"\n";
  return cell_m;
}

std::string draw_scene() {
  std::string text;
  const double cell_m = draw_cloth(text);
  text += "[material]\n";
  for (const char* key : {"density", "membrane", "shear", "bend", "damping", "damping_ratio_max"})
    text += line("material", key);
  text += fmt::format("flex = {:.6f}\n", uniform(0.0, 1.0));
  for (int pins = whole(0, 2); pins > 0; --pins)
    text += fmt::format("[[pins]]\nat = [{:.6f}, {:.6f}]\nradius = {:.9e}\n", uniform(0.0, 1.0),
                        uniform(0.0, 1.0), log_uniform(0.71 * cell_m, 1000.0));
  if (chance(0.8)) text += "[gravity]\n" + line("gravity", "acceleration");
  if (chance(0.5)) {
    text += "[air]\n" + line("air", "drag");
    if (chance(0.5))
      text += "[wind]\n" + line("wind", "velocity") + line("wind", "gust") +
              fmt::format("period = {:.9e}\n", log_uniform(1e-3, 1e6));
  }
  if (chance(0.4)) text += "[floor]\n" + line("floor", "height") + line("floor", "friction");
  for (int spheres = whole(0, 2); spheres > 0; --spheres) {
    text += "[[spheres]]\n";
    for (const char* key : {"center", "radius", "velocity", "friction"}) text += line("spheres", key);
  }
  if (chance(0.2))
    text +=
        fmt::format("[self_collision]\nthickness = {:.9e}\n", log_uniform(1e-6, std::min(1.0, 9.9 * cell_m)));
  return text + "[solver]\n" + line("solver", "frame");
}

/// The frame that is asked for, or as much of it as `kSubstepsMost` substeps make.
struct Step {
  double frame_s;
  std::uint32_t substeps;
};
Step step_of(Model& model) {
  const double substep_s = 0.9 * find_solver("leapfrog").step_max_s(model.bound);
  const double frame_s = std::min(model.scene.solver.frame_s, kSubstepsMost * substep_s);
  model.scene.solver.substeps =
      static_cast<std::uint32_t>(std::max(1.0, std::ceil(frame_s / substep_s - 1e-9)));
  return {frame_s, model.scene.solver.substeps};
}

/// Whether nothing that a scene has gives energy: wind, spheres that move, contact that begins inside.
bool gives_no_energy(const Model& model) {
  for (const SphereSection& sphere : model.scene.spheres)
    if (sphere.velocity_m_s != glm::dvec3(0.0)) return false;
  return !model.scene.wind && !model.scene.self_collision &&
         deepest_penetration(model, start_state(model)) == 0.0;
}

void stays_finite(const std::string& text) {
  Model model = build_model(parse_scene(text, "drawn.toml").scene);
  const Step step = step_of(model);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  for (std::uint32_t f = 0; f < kFrames; ++f) simulation->advance(step.frame_s, step.substeps);
  const std::optional<Divergence> found = simulation->divergence();
  if (found) RC_FAIL(what_happened(*found, model) + " in\n" + text);
  RC_ASSERT(all_finite(simulation->read()));
}

/// What the springs store when each end is off by some hundred roundings of a double.
double noise_j(const Model& model) {
  double farthest_m = 0.0, stiffness_n_m = 0.0;
  for (const glm::dvec3& x : start_state(model).position) farthest_m = std::max(farthest_m, glm::length(x));
  for_each_spring(model, [&](const SpringKind& kind, std::uint32_t, std::uint32_t, double weight) {
    stiffness_n_m += weight * kind.stiffness_n_m;
  });
  for_each_triple(model, [&](std::uint32_t, std::uint32_t, std::uint32_t, double kappa) {
    stiffness_n_m += 16.0 * kappa;
  });
  return 0.5 * stiffness_n_m * std::pow(200.0 * 0x1p-53 * farthest_m, 2);
}

/// In double, since rounding strains springs a thousand times as stiff as cotton a kilometre away.
void makes_no_energy(const std::string& text) {
  Model model = build_model(parse_scene(text, "drawn.toml").scene);
  if (!gives_no_energy(model)) return;
  const Step step = step_of(model);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f64");
  const Energy start = energy(model, simulation->read());
  const double stored_j = start.elastic_j + start.bending_j;
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    simulation->advance(step.frame_s, step.substeps);
    const Energy now = energy(model, simulation->read());
    const double moving_j = now.kinetic_j + now.elastic_j + now.bending_j;
    const double rounding_j = 1e-9 * (std::abs(start.gravity_j) + std::abs(now.gravity_j)) + noise_j(model);
    if (now.total() - start.total() > kEnergyShare * std::max(stored_j, moving_j) + rounding_j)
      RC_FAIL(fmt::format("{} J at the start, {} J after frame {}, of which {} J move or are stored, in\n{}",
                          start.total(), now.total(), f + 1, moving_j, text));
  }
}

TEST(RandomScenes, StayFiniteAndMakeNoEnergy) {
  const char* wish = std::getenv("WEFT_PROPERTY_SCENES");
  setenv("RC_PARAMS",
         fmt::format("max_success={} seed=20261122 noshrink=0", wish != nullptr ? wish : "1000").c_str(), 0);
  EXPECT_TRUE(rc::check("any scene", [] {
    const std::string text = draw_scene();
    stays_finite(text);
    makes_no_energy(text);
  }));
}

}  // namespace
}  // namespace weft::hard
