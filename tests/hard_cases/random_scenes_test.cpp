// Any scene that the reader takes stays finite: every number drawn log-uniformly from its whole allowed
// range, as the parameter table has it, with the work of a run capped. WEFT_PROPERTY_SCENES=100000 draws more
// than the 1000 of the quick tests; RapidCheck prints what repeats a failure and makes the scene simpler
// first.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "hard_cases/draw.h"
#include "model/measures.h"
#include "model/motion.h"
#include "model/solids.h"
#include "model/springs.h"
#include "scene/parameters.h"
#include "scene/reader.h"
#include "sim/simulation.h"

namespace weft::hard {
namespace {

constexpr std::uint32_t kFrames = 2;  // of kSubstepsMost at most: 200 substeps
constexpr std::uint32_t kResolutionMost = 32;
/// Leapfrog conserves a neighbour of the energy, which near its largest step swings about it.
constexpr double kEnergyShare = 0.25;

std::string line(std::string_view section, std::string_view key) {
  const Parameter& parameter = *find_parameter(section, key);
  if (parameter.kind == ParameterKind::integer)
    return fmt::format("{} = {:.0f}\n", key,
                       log_uniform(std::max(1.0, parameter.minimum), parameter.maximum));
  if (parameter.kind == ParameterKind::vec3)
    return fmt::format("{} = [{:.9e}, {:.9e}, {:.9e}]\n", key, number(parameter), number(parameter),
                       number(parameter));
  return fmt::format("{} = {:.9e}\n", key, number(parameter));
}

/// The cloth and its pins, which depend on one another; returns the cell [m].
double draw_cloth(std::string& text) {
  const Parameter& width = *find_parameter("cloth", "width");
  const auto resolution = static_cast<std::uint32_t>(std::lround(log_uniform(2.0, kResolutionMost)));
  const double cell_m = log_uniform(width.minimum, width.maximum / 31.0);
  const double rows = std::round(log_uniform(1.0, kResolutionMost - 1.0));
  text += fmt::format("[cloth]\nresolution = {}\nwidth = {:.9e}\nheight = {:.9e}\n", resolution,
                      cell_m * (resolution - 1), cell_m * rows);
  text += line("cloth", "center");
  text += fmt::format("imperfection = {:.9e}\n", log_uniform(1e-9, 1.0));
  if (chance(0.5)) text += "orientation = \"horizontal\"\n";
  return cell_m;
}

/// Keys of a motion within a metre or ten of a place, as fast as the reader allows at the most.
std::string draw_keys(const char* place) {
  std::string text = "keys = [";
  double time_s = 0.0;
  for (int keys = whole(1, 4); keys > 0; --keys) {
    const double reach_m = log_uniform(1e-3, 10.0);
    text +=
        fmt::format("{{ time = {:.9e}, {} = [{:.6e}, {:.6e}, {:.6e}] }}, ", time_s, place,
                    reach_m * uniform(-1.0, 1.0), reach_m * uniform(-1.0, 1.0), reach_m * uniform(-1.0, 1.0));
    time_s += log_uniform(0.04, 1.0);  // two places are 35 m apart at most
  }
  return text + "]\n";
}

bool is_number(const Parameter& parameter) {
  return parameter.kind == ParameterKind::number || parameter.kind == ParameterKind::integer ||
         parameter.kind == ParameterKind::vec3;
}

/// Every key of the material that is a number, so that a new one is drawn by itself.
std::string draw_material() {
  constexpr std::array<std::string_view, 6> kAlways{"density", "membrane", "shear",
                                                    "bend",    "damping",  "damping_ratio_max"};
  std::string text = "[material]\n";
  for (const Parameter& parameter : parameters()) {
    if (parameter.section != "material" || !is_number(parameter) || parameter.key == "flex") continue;
    if (std::ranges::find(kAlways, parameter.key) != kAlways.end() || chance(0.15))
      text += line("material", parameter.key);
  }
  return text + fmt::format("flex = {:.6f}\n", uniform(0.0, 1.0));
}

/// A section with what it requires and half of its other numbers; "" with that chance.
std::string draw_section(std::string_view section, double share) {
  if (!chance(share)) return "";
  std::string text =
      is_list_section(section) ? fmt::format("[[{}]]\n", section) : fmt::format("[{}]\n", section);
  for (const Parameter& parameter : parameters())
    if (parameter.section == section && is_number(parameter) && (parameter.required || chance(0.5)))
      text += line(section, parameter.key);
  return text;
}

/// A ring somewhere, of three sizes, whose distances are computed once.
std::string draw_mesh() {
  return fmt::format("[[meshes]]\nfile = \"{}/assets/meshes/ring.obj\"\nscale = {}\nresolution = 8\n",
                     WEFT_SOURCE_DIR, std::pow(10.0, whole(-1, 1))) +
         line("meshes", "rotation") +
         (chance(0.3) ? draw_keys("center") : line("meshes", "center") + line("meshes", "velocity"));
}

/// The sections that draw_scene() does not draw itself: a new one is drawn by itself.
std::string draw_other_sections() {
  constexpr std::array<std::string_view, 13> kElsewhere{
      "",      "cloth",   "material",       "pins",   "gravity", "air",   "wind",
      "floor", "spheres", "self_collision", "meshes", "solver",  "expect"};
  std::string text;
  for (const std::string_view section : section_names()) {
    if (std::ranges::find(kElsewhere, section) != kElsewhere.end()) continue;
    text += draw_section(section, 0.15);
  }
  return text;
}

std::string draw_scene() {
  std::string text;
  const double cell_m = draw_cloth(text);
  text += draw_material();
  for (int pins = whole(0, 2); pins > 0; --pins)
    text += fmt::format("[[pins]]\nat = [{:.6f}, {:.6f}]\nradius = {:.9e}\n", uniform(0.0, 1.0),
                        uniform(0.0, 1.0), log_uniform(0.71 * cell_m, 1000.0)) +
            (chance(0.3) ? draw_keys("offset") : "") +
            (chance(0.1) ? fmt::format("release = {:.9e}\n", log_uniform(1e-6, 1.0)) : "");
  if (chance(0.8)) text += "[gravity]\n" + line("gravity", "acceleration");
  if (chance(0.5)) {
    text += "[air]\n" + line("air", "drag");
    if (chance(0.5))
      text += "[wind]\n" + line("wind", "velocity") + line("wind", "gust") +
              fmt::format("period = {:.9e}\n", log_uniform(1e-3, 1e6));
  }
  if (chance(0.4)) {
    text += "[floor]\n" + line("floor", "height") + line("floor", "friction");
    if (chance(0.3))
      text += fmt::format("normal = [{:.6f}, 1, {:.6f}]\n", uniform(-1.0, 1.0), uniform(-1.0, 1.0));
  }
  text += draw_other_sections();
  for (int spheres = whole(0, 2); spheres > 0; --spheres) {
    text += "[[spheres]]\n";
    for (const char* key : {"radius", "friction"}) text += line("spheres", key);
    text += chance(0.3) ? draw_keys("center") : line("spheres", "center") + line("spheres", "velocity");
  }
  if (chance(0.2))
    text +=
        fmt::format("[self_collision]\nthickness = {:.9e}\n", log_uniform(1e-6, std::min(1.0, 9.9 * cell_m)));
  if (chance(0.05)) text += draw_mesh();
  return text + "[solver]\n" + line("solver", "frame");
}

/// Whether nothing that a scene has gives energy: wind, colliders and pins that move, contact that begins
/// inside, a limit that lifts what hangs.
bool gives_no_energy(const Model& model) {
  for (const SphereSection& sphere : model.scene.spheres)
    if (sphere.velocity_m_s != glm::dvec3(0.0) || sphere.keys.size() > 1) return false;
  for (const Solid& solid : solids_of(model.scene))
    if (solid.section->velocity_m_s != glm::dvec3(0.0) || solid.section->keys.size() > 1) return false;
  for (const MeshSection& mesh : model.scene.meshes)
    if (mesh.velocity_m_s != glm::dvec3(0.0) || mesh.keys.size() > 1) return false;
  for (const PinSection& pin : model.scene.pins)
    if (pin.keys.size() > 1 || pin.release_s) return false;  // what it lets go of joins the sum
  return !model.scene.wind && !model.scene.self_collision && model.scene.material.strain_limit == 0.0 &&
         deepest_penetration(model, start_state(model)) == 0.0;
}

/// Whether neighbours keep their sides of one another at the start, or damping takes what their flying over
/// one another gives (docs/stability.md "Where no bound holds"). Contact that begins inside, spheres and pins
/// that move by more than a cell crush a cloth, too.
/// @param pushed_m  by how much forces can move a particle in the run
bool is_bounded(const Model& model, const Step& step, double pushed_m) {
  if (damping_ratios(model).least >= kDampingRatioEnough) return true;
  double moved_m = std::max(pushed_m, deepest_penetration(model, start_state(model)));
  for (const SphereSection& sphere : model.scene.spheres)
    moved_m = std::max(moved_m, kFrames * step.frame_s *
                                    std::max(glm::length(sphere.velocity_m_s), fastest_m_s(sphere.keys)));
  for (const Solid& solid : solids_of(model.scene))
    moved_m = std::max(moved_m, kFrames * step.frame_s * fastest_m_s(*solid.section, extent_m(solid)));
  for (const MeshSection& mesh : model.scene.meshes)
    moved_m = std::max(moved_m, kFrames * step.frame_s * fastest_m_s(mesh, 10.0));
  for (const PinSection& pin : model.scene.pins)
    moved_m = std::max(moved_m, kFrames * step.frame_s * fastest_m_s(pin.keys));
  return moved_m <= 0.5 * model.grid.spacing_m && stretch(model, start_state(model)).maximum <= 0.5;
}

void stays_finite(const std::string& text) {
  Model model = build_model(parse_scene(text, "drawn.toml").scene);
  const Step step = step_of(model);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  for (std::uint32_t f = 0; f < kFrames; ++f) simulation->advance(step.frame_s, step.substeps);
  const std::optional<Divergence> found = simulation->divergence();
  RC_CLASSIFY(is_bounded(model, step, 0.0), "bounded");
  if (found && is_bounded(model, step, 0.0)) RC_FAIL(what_happened(*found, model) + " in\n" + text);
  if (found) RC_ASSERT(likely_cause(*found, model, simulation->plan()) != "");
  RC_ASSERT(all_finite(simulation->last_good().value()));
  RC_ASSERT(found || all_finite(simulation->read()));
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
  const Step step = step_of(model);
  const double gravity_m_s2 = model.scene.gravity ? glm::length(model.scene.gravity->acceleration_m_s2) : 0.0;
  const double fall_m = 0.5 * gravity_m_s2 * std::pow(kFrames * step.frame_s, 2);
  if (!gives_no_energy(model) || !is_bounded(model, step, fall_m)) return;
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
  EXPECT_TRUE(holds("any scene", 1000, "WEFT_PROPERTY_SCENES", [] {
    const std::string text = draw_scene();
    try {
      stays_finite(text);
      makes_no_energy(text);
    } catch (const Error& refusal) {  // what leapfrog has no passes for, or what does not stand together
      RC_ASSERT(refusal.code() == Exit::usage);
      RC_TAG("refused");
    }
  }));
}

}  // namespace
}  // namespace weft::hard
