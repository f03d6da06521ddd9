// What a scene pays for: the plan holds exactly the passes and buffers of the effects that the scene names.
#include "scene/effects.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "plan/buffers.h"
#include "plan/plan.h"
#include "scene/reader.h"

namespace weft {
namespace {

/// 12 × 12 particles and nothing else, stepped as often whatever is added, by the solver that has every
/// effect's passes.
Scene base_scene() {
  return parse_scene("[cloth]\nresolution = 12\n[material]\ndamping = 0\n[solver]\nsubsteps = 40\n",
                     "base.toml")
      .scene;
}

Plan plan_of(const Scene& scene) {
  return compile_plan(build_model(scene), find_solver(scene.solver.name), scene.solver.precision);
}

std::string plan_text(const Scene& scene) {
  const Model model = build_model(scene);
  return to_json(compile_plan(model, find_solver(scene.solver.name), scene.solver.precision), model);
}

/// The words that a scene's effects put into its plan: passes, buffers, and constants that are not 0.
std::set<std::string> words_of(const Plan& plan) {
  std::set<std::string> words;
  for (const PlanStep& step : plan.steps) {
    // Where links break, a pass with that in its name stands for the one without, with the same constants.
    std::string name(step.pass->name);
    if (name.ends_with("_torn")) name.resize(name.size() - std::string_view("_torn").size());
    words.insert("pass " + name);
    for (const Constant& constant : step.constants)
      if (constant.value != 0) words.insert("constant " + std::string(constant.name));
  }
  for (const PlanBuffer& buffer : plan.buffers) words.insert("buffer " + std::string(row_of(buffer.id).name));
  return words;
}

std::set<std::string> united(std::set<std::string> a, const std::set<std::string>& b) {
  a.insert(b.begin(), b.end());
  return a;
}

class EffectPairs : public testing::TestWithParam<std::string> {};

// Of two effects the plan has what each of them brings alone, and nothing more.
TEST_P(EffectPairs, BringWhatEachBringsAlone) {
  const Scene base = base_scene();
  const Scene first = with_effect(base, GetParam());
  const auto own = words_of(plan_of(first));
  for (const Effect& other : effects()) {
    if (!stand_together(find_effect(GetParam()), other)) continue;
    const Scene second = with_effect(base, other.name), both = with_effect(first, other.name);
    std::set<std::string> expected = united(own, words_of(plan_of(second)));
    // Frames without self-collision's passes are for cloth that nothing but `integrate` moves.
    if (!plan_of(both).spreads) expected.erase("buffer spread_state");
    EXPECT_EQ(words_of(plan_of(both)), expected) << GetParam() << " + " << other.name;
    std::uint64_t sum = 0;
    for (const PlanBuffer& buffer : plan_of(both).buffers) sum += buffer.bytes;
    EXPECT_EQ(plan_of(both).bytes(), sum);
  }
}

// A scene that has lost an effect is the scene that never heard of it: the same plan, bytes and reasons.
TEST_P(EffectPairs, LeaveNothingBehind) {
  const Effect& effect = find_effect(GetParam());
  for (const Effect& other : effects()) {
    if (!stand_together(effect, other)) continue;
    const Scene before = with_effect(base_scene(), other.name);
    if (has_effect(before, effect)) continue;
    Scene lost = without_effect(with_effect(before, effect.name), effect.name);
    const bool need_came_too = !effect.needs.empty() && !has_effect(before, find_effect(effect.needs));
    if (need_came_too) lost = without_effect(lost, effect.needs);
    EXPECT_EQ(plan_text(lost), plan_text(before)) << effect.name << " beside " << other.name;
  }
}

// Each effect changes the plan: none is a name without a pass, buffer or constant.
TEST_P(EffectPairs, AreSeenInThePlan) {
  const Scene base = base_scene();
  EXPECT_NE(words_of(plan_of(with_effect(base, GetParam()))), words_of(plan_of(base)));
}

std::vector<std::string> names_of_effects() {
  std::vector<std::string> names;
  for (const Effect& effect : effects())
    if (effect.solver.empty()) names.emplace_back(effect.name);  // tethers: tests/physics/tethers_test.cpp
  return names;
}

INSTANTIATE_TEST_SUITE_P(Each, EffectPairs, testing::ValuesIn(names_of_effects()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace weft
