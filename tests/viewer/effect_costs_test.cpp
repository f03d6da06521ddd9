// What effects cost: which passes are an effect's own, and the trial of those that are folded together.
#include "viewer/effect_costs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gpu/buffer.h"
#include "gpu_fixture.h"
#include "model/measures.h"
#include "plan/plan.h"
#include "scene/effects.h"
#include "viewer/parameter_widgets.h"

namespace weft {
namespace {

Scene scene_with_everything() {
  Scene scene = load_scene(find_scene("1"), {{"cloth.resolution=24"}}).scene;
  for (const char* section : {"floor", "spheres", "self_collision"}) add_visible_section(scene, section);
  return scene;
}

TEST(PassesOfEffect, AreWhatThePlanLosesWithoutIt) {
  const Scene scene = scene_with_everything();
  const auto own = passes_of_effect(scene, "self_collision");
  EXPECT_FALSE(own.empty());
  EXPECT_NE(std::ranges::find(own, "self_contact"), own.end());
  const Plan without =
      compile_plan(build_model(without_effect(scene, "self_collision")), find_solver(scene.solver.name));
  for (const PlanStep& step : without.steps)
    EXPECT_EQ(std::ranges::find(own, step.pass->name), own.end()) << step.pass->name;
  for (const char* folded : {"wind", "air", "gravity", "floor", "spheres", "bend"})
    EXPECT_TRUE(passes_of_effect(scene, folded).empty())
        << folded << " is arithmetic in a pass that runs anyway";
}

class EffectCostsTest : public test::GpuTest {};

TEST_F(EffectCostsTest, ATrialTellsEveryEffectAndLeavesNothing) {
  RunningScene running(device(), {{"cloth.resolution=12"}}, "1");
  running.apply(scene_with_everything());
  running.set_paused(true);
  const auto frame = [&] {
    running.step();
    do running.advance(0.0, 0.05);
    while (running.mid_frame());
  };
  frame();
  const std::uint64_t hash = state_hash(running.simulation().read());
  gpu::Allocator& allocator = device().allocator();
  const std::uint64_t count = allocator.live_count(), bytes = allocator.live_bytes();
  EffectCosts costs(device());
  costs.follow(running);
  EXPECT_NE(costs.text("self_collision").find(" ms"), std::string::npos) << "timed by itself";
  EXPECT_EQ(costs.text("self_collision").find("trial"), std::string::npos);
  EXPECT_EQ(costs.text("wind"), "") << "not known before a trial";
  costs.start_trial(running);
  int pictures = 0;
  for (; costs.trial() != nullptr && pictures < 5000; ++pictures) costs.follow(running);
  EXPECT_GT(pictures, 50) << "a part at a time";
  for (const char* effect : {"bend", "gravity", "air", "wind", "floor", "spheres"})
    EXPECT_NE(costs.text(effect).find("(trial)"), std::string::npos) << effect;
  EXPECT_EQ(allocator.live_count(), count);
  EXPECT_EQ(allocator.live_bytes(), bytes);
  EXPECT_EQ(state_hash(running.simulation().read()), hash) << "the running cloth is untouched";
  Scene finer = running.scene();
  finer.cloth.resolution = 14;
  running.apply(finer);
  costs.follow(running);
  EXPECT_EQ(costs.text("wind"), "") << "forgotten with the plan";
}

// On a device that counts honestly, a frame with self-collision takes longer than one without: it has more
// passes. The trial must see that, at a size where it is far above the noise.
TEST_F(EffectCostsTest, SelfCollisionIsSeenToCost) {
  RunningScene running(device(), {{"cloth.resolution=32"}}, "1");
  Scene scene = running.scene();
  for (const std::string& other : removable_effects(scene)) scene = without_effect(scene, other);
  add_visible_section(scene, "self_collision");
  running.apply(scene);
  const auto pipelines = std::make_shared<GpuPipelines>(device());
  EffectTrial trial(running.simulation(),
                    [&](const Model& model) { return running.copy_of(model, pipelines); });
  while (trial.go_on()) {
  }
  const EffectCost cost = trial.costs().at("self_collision");
  EXPECT_GT(cost.ms, cost.doubt_ms);
}

TEST_F(EffectCostsTest, SelfCollisionCanBeSwitchedInEveryScene) {
  for (const char* name : {"1", "2", "3", "4", "5", "6"}) {
    RunningScene running(device(), {{"cloth.resolution=20"}}, name);
    running.set_paused(true);
    const auto frames = [&](int count) {
      for (int k = 0; k < count; ++k) {
        running.step();
        do running.advance(0.0, 0.05);
        while (running.mid_frame());
      }
    };
    Scene scene = running.scene();
    scene.self_collision.reset();
    running.apply(scene);
    const std::uint64_t without = running.simulation().plan().bytes();
    add_visible_section(scene, "self_collision");
    running.apply(scene);
    frames(3);
    EXPECT_TRUE(running.simulation().self_collision()) << "scene " << name;
    EXPECT_GT(running.simulation().plan().bytes(), without);
    scene.self_collision->thickness_m *= 0.8;
    running.apply(scene);
    frames(3);
    EXPECT_TRUE(all_finite(running.simulation().read())) << "scene " << name;
    scene.self_collision.reset();
    running.apply(scene);
    frames(1);
    EXPECT_EQ(running.simulation().plan().bytes(), without) << "off it leaves the plan";
  }
}

}  // namespace
}  // namespace weft
