// What a scene pays for: the plan holds exactly the passes and buffers of the effects that the scene names.
#include "scene/effects.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>

#include "plan/buffers.h"
#include "plan/plan.h"
#include "scene/reader.h"

namespace weft {
namespace {

/// 12 × 12 particles and nothing else, stepped as often whatever is added, by leapfrog, which has the passes
/// of every effect that is not another solver's alone.
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

/// The base that both can be added to, by the solver that has the passes of both; nothing where none has, or
/// where they may not stand together.
std::optional<Scene> base_for(const Effect& a, const Effect& b) {
  if (a.not_with == b.name || b.not_with == a.name) return std::nullopt;
  Scene base = base_scene();
  for (const Effect* effect : {&a, &b})
    if (!effect->solver.empty()) base.solver.name = effect->solver;
  const Model both = build_model(with_effect(with_effect(base, a.name), b.name));
  if (!what_solver_lacks(both, find_solver(base.solver.name)).empty()) return std::nullopt;
  return base;
}

class EffectPairs : public testing::TestWithParam<std::string> {};

// Of two effects the plan has what each of them brings alone, and nothing more.
TEST_P(EffectPairs, BringWhatEachBringsAlone) {
  for (const Effect& other : effects()) {
    const auto base = base_for(find_effect(GetParam()), other);
    if (!base) continue;
    const Scene first = with_effect(*base, GetParam()), second = with_effect(*base, other.name);
    const Scene both = with_effect(first, other.name);
    std::set<std::string> expected = united(words_of(plan_of(first)), words_of(plan_of(second)));
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
    const auto base = base_for(effect, other);
    if (!base) continue;
    const Scene before = with_effect(*base, other.name);
    if (has_effect(before, effect)) continue;
    Scene lost = without_effect(with_effect(before, effect.name), effect.name);
    const bool need_came_too = !effect.needs.empty() && !has_effect(before, find_effect(effect.needs));
    if (need_came_too) lost = without_effect(lost, effect.needs);
    EXPECT_EQ(plan_text(lost), plan_text(before)) << effect.name << " beside " << other.name;
  }
}

// Each effect changes the plan, also beside what it needs: none is a name without a pass, buffer or constant.
TEST_P(EffectPairs, AreSeenInThePlan) {
  const Effect& effect = find_effect(GetParam());
  Scene base = *base_for(effect, effect);
  if (!effect.needs.empty()) base = with_effect(base, effect.needs);
  EXPECT_NE(words_of(plan_of(with_effect(base, effect.name))), words_of(plan_of(base)));
}

// Of those that are one solver's alone: they meet all that it has, and no pair is left out by mistake.
TEST(Effects, OfOneSolverMeetWhatItHas) {
  std::set<std::string_view> met;
  for (const Effect& other : effects())
    if (base_for(find_effect("tethers"), other)) met.insert(other.name);
  EXPECT_EQ(met, (std::set<std::string_view>{"bend", "damping", "pins", "gravity", "air", "wind", "floor",
                                             "spheres", "capsules", "boxes", "meshes", "tethers",
                                             "aerodynamics", "strain_limit"}));
}

std::vector<std::string> names_of_effects() {
  std::vector<std::string> names;
  for (const Effect& effect : effects()) names.emplace_back(effect.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Each, EffectPairs, testing::ValuesIn(names_of_effects()),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace weft
