// Moves sliders of the parameter table at random while a cloth runs, as a hand at the window would, and types
// a number from the whole allowed range now and then: the default solver stays finite at every frame's end,
// or is stopped where docs/stability.md says so.
// WEFT_PROPERTY_WALKS=10000 walks more often than the quick tests.
#include <gtest/gtest.h>

#include <glm/vec3.hpp>
#include <string>

#include "core/error.h"
#include "hard_cases/draw.h"
#include "model/carry.h"
#include "model/measures.h"
#include "scene/effects.h"
#include "scene/reader.h"
#include "sim/native_simulation.h"

namespace weft::hard {
namespace {

constexpr int kFramesPerWalk = 60;
constexpr std::uint32_t kWalkResolutionMost = 24;

/// Sliders that change the cloth or what acts on it. Substeps are left on automatic, and the reader's limits
/// of grids belong to the reader's tests.
bool walks(const Parameter& parameter) {
  const bool numeric = parameter.kind != ParameterKind::word && parameter.kind != ParameterKind::keys;
  return numeric && parameter.section != "solver" && parameter.section != "expect" &&
         parameter.section != "" && parameter.slider_maximum > parameter.slider_minimum;
}

/// A position of the slider: log-uniform, over five decades where it begins at 0, on both sides where it has
/// two.
double slider_position(const Parameter& parameter) {
  const double most = parameter.slider_maximum;
  if (parameter.slider_minimum > 0.0) return log_uniform(parameter.slider_minimum, most);
  if (chance(0.15)) return 0.0;
  const double size = log_uniform(1e-5 * most, most);
  return parameter.slider_minimum < 0.0 && chance(0.5) ? -size : size;
}

double drawn_value(const Parameter& parameter, bool typed) {
  if (parameter.kind == ParameterKind::integer)
    return std::round(log_uniform(parameter.minimum, kWalkResolutionMost));
  return typed ? number(parameter) : slider_position(parameter);
}

void move_slider(Scene& scene) {
  std::vector<const Parameter*> there;
  for (const Parameter& parameter : parameters())
    if (walks(parameter) && item_count(scene, parameter.section) > 0) there.push_back(&parameter);
  const Parameter& parameter = *there[static_cast<std::size_t>(whole(0, static_cast<int>(there.size()) - 1))];
  const auto item =
      static_cast<std::size_t>(whole(0, static_cast<int>(item_count(scene, parameter.section)) - 1));
  const bool typed = chance(0.1);
  if (parameter.kind == ParameterKind::vec3)
    parameter.set(scene, item,
                  glm::dvec3(drawn_value(parameter, typed), drawn_value(parameter, typed),
                             drawn_value(parameter, typed)));
  else
    parameter.set(scene, item, drawn_value(parameter, typed));
}

/// Puts what an effect adds far below the cloth just below it.
void bring_near(Scene& scene, std::string_view section) {
  for (const Parameter& parameter : parameters()) {
    const bool place =
        parameter.section == section && parameter.kind == ParameterKind::vec3 && parameter.unit == "m";
    if (!place) continue;
    for (std::size_t item = 0; item < item_count(scene, section); ++item) {
      const auto far = std::get<glm::dvec3>(parameter.get(scene, item));
      parameter.set(scene, item, far + glm::dvec3(0.1, kEffectFar_m - 0.6, 0.0));
    }
  }
}

/// Switches an effect of the list on or off, so that a new one is switched by itself.
void flip_switch(Scene& scene) {
  const Effect& effect =
      effects()[static_cast<std::size_t>(whole(0, static_cast<int>(effects().size()) - 1))];
  if (has_effect(scene, effect)) {
    scene = without_effect(scene, effect.name);
    return;
  }
  for (const std::string& other : effects_of(scene))
    if (!stand_together(effect, find_effect(other))) return;
  if (!effect.solver.empty()) return;  // leapfrog has not got it
  scene = with_effect(scene, effect.name);
  bring_near(scene, effect.name);
}

bool same_cloth(const ClothSection& a, const ClothSection& b) {
  return a.resolution == b.resolution && a.width_m == b.width_m && a.height_m == b.height_m &&
         a.center_m == b.center_m && a.imperfection_m == b.imperfection_m;
}

/// A cloth in the middle of a walk.
struct Walker {
  Scene scene;
  Model model;
  std::unique_ptr<HostSimulation> simulation;
  std::string told;  ///< what was done, for a failure's report

  /// Runs on with another scene as the window does: in the same simulation where that can adopt it, else in
  /// another that the state is carried to; with the scene before where the model refuses the new one.
  void adopt(const Scene& next) {
    try {
      Model made = build_model(next);
      const Step step = step_of(made);
      if (!simulation || !same_cloth(scene.cloth, next.cloth) || !simulation->adopt(made)) {
        auto other = make_native_simulation(made, find_solver("leapfrog"), "f32");
        if (simulation) other->write(carry_state(model, simulation->read(), made));
        simulation = std::move(other);
      }
      scene = next;
      model = std::move(made);
      frame = step;
    } catch (const Error&) {
      told += " (refused)";
    }
  }
  Step frame{};
};

std::string differences(const Scene& before, const Scene& after) {
  std::string text;
  for (const Parameter& parameter : parameters())
    for (std::size_t item = 0; item < item_count(after, parameter.section); ++item) {
      const std::string now = value_text(parameter.get(after, item));
      if (item < item_count(before, parameter.section) && value_text(parameter.get(before, item)) == now)
        continue;
      text += fmt::format(" {}.{}={}", parameter.section, parameter.key, now);
    }
  return text;
}

/// A run may be stopped where it was crushed with next to no damping (docs/stability.md "Where no bound
/// holds"): then there is a state to go back to.
void found_out(const Walker& walker, const Divergence& found) {
  if (damping_ratios(walker.model).least >= kDampingRatioEnough)
    RC_FAIL(what_happened(found, walker.model) + " after " + walker.told);
  RC_ASSERT(all_finite(walker.simulation->last_good().value()));
  RC_TAG("found out");
}

void walk_stays_finite() {
  Walker walker;
  const std::string start = std::to_string(whole(1, 6));
  walker.adopt(load_scene(find_scene(start),
                          {{"cloth.resolution=16", "pins=[{at=[0,0],radius=0.05},{at=[1,0],radius=0.05}]"}})
                   .scene);
  walker.told = "scene " + start;
  for (int f = 0; f < kFramesPerWalk; ++f) {
    if (chance(0.7)) {
      Scene next = walker.scene;
      next.solver.substeps = 0;
      chance(0.1) ? flip_switch(next) : move_slider(next);
      walker.told += fmt::format("\n{}:{}", f, differences(walker.scene, next));
      walker.adopt(next);
    }
    walker.simulation->advance(walker.frame.frame_s, walker.frame.substeps);
    const std::optional<Divergence> found = walker.simulation->divergence();
    if (found) return found_out(walker, *found);
    RC_ASSERT(all_finite(walker.simulation->read()));
  }
}

TEST(SliderWalks, StayFiniteAtEveryFrame) {
  EXPECT_TRUE(holds("any walk", 40, "WEFT_PROPERTY_WALKS", walk_stays_finite));
}

}  // namespace
}  // namespace weft::hard
