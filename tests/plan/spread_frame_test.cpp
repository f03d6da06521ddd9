// A frame in which the cloth stays spread out has none of self-collision's passes, and what is left is the
// scene without the section and looks.
#include "plan/spread_frame.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "passes/passes.h"
#include "plan/spread_bound.h"
#include "scene/reader.h"
#include "solvers/solver.h"

namespace weft {
namespace {

Model model_of(const std::string& more, double thickness_m = 0.01) {
  const std::string contact =
      thickness_m > 0 ? fmt::format("[self_collision]\nthickness = {}\n", thickness_m) : "";
  return build_model(
      parse_scene("[cloth]\nresolution = 24\n[gravity]\n" + contact + more, "spread.toml").scene);
}

Plan plan_of(const Model& model) {
  return compile_plan(model, find_solver("leapfrog"), model.scene.solver.precision);
}

TEST(SpreadFrame, HasThePassesOfTheSceneWithoutTheSectionAndLooks) {
  const std::string substeps = "[solver]\nsubsteps = 100\n";
  const Model model = model_of(substeps);
  const Plan plan = plan_of(model), without = plan_of(model_of(substeps, 0.0));
  ASSERT_TRUE(plan.spreads);
  EXPECT_FALSE(without.spreads);
  for (const std::uint32_t interval : {1u, 7u, 32u, 128u}) {
    SCOPED_TRACE(interval);
    const Plan frame = spread_frame(plan, model, interval);
    std::vector<const Pass*> left;
    for (const PlanStep& step : frame.steps)
      if (step.pass != &spread_look) left.push_back(step.pass);
    std::vector<const Pass*> plain;
    for (const PlanStep& step : without.steps) plain.push_back(step.pass);
    EXPECT_EQ(left, plain);
    const std::uint64_t looks =
        (100 - 1) / interval + 1 + 1;  // substeps 0, interval, ..., and the frame's end
    EXPECT_EQ(frame.dispatches(), without.dispatches() + looks);
  }
}

// The device proves the frame before it keeps what came of it: the watch for divergence comes last.
TEST(SpreadFrame, EndsWithTheWatch) {
  const Model model = model_of("");
  const Plan frame = spread_frame(plan_of(model), model, 8);
  ASSERT_GE(frame.steps.size(), 4u);
  for (std::size_t k = frame.steps.size() - 3; k < frame.steps.size(); ++k)
    EXPECT_TRUE(watches(*frame.steps[k].pass));
  EXPECT_FALSE(watches(*frame.steps[frame.steps.size() - 4].pass));
}

// Where something else moves the cloth between two looks, or numbers are no floats, nothing is proven.
TEST(SpreadFrame, IsForOneClothInFloatThatIntegrateAloneMoves) {
  for (const char* more : {"", "[floor]\nheight = -1\n", "[[spheres]]\ncenter = [0, -2, 0]\nradius = 0.5\n",
                           "[air]\ndrag = 0.1\n[wind]\nvelocity = [3, 0, 0]\n"})
    EXPECT_TRUE(plan_of(model_of(more)).spreads) << more;
  for (const char* more :
       {"[[capsules]]\na = [0, -2, 0]\nb = [1, -2, 0]\nradius = 0.1\n", "[material]\nstrain_limit = 0.1\n",
        "[tearing]\nstrain = 0.5\n", "[aerodynamics]\n", "[[cloths]]\ncenter = [0, 1, 0]\n",
        "[solver]\nprecision = \"f64\"\n", "[solver]\nprecision = \"f32k\"\n"}) {
    const Plan plan = plan_of(model_of(more));
    EXPECT_FALSE(plan.spreads) << more;
    EXPECT_TRUE(std::ranges::none_of(plan.buffers, [](const PlanBuffer& buffer) {
      return buffer.id == BufferId::spread_state;
    })) << more;
  }
}

// Of a cloth that is thicker than its cells are wide everything is in reach of something, however flat.
TEST(SpreadFrame, IsNotForClothThatIsThickerThanItsCells) {
  EXPECT_TRUE(plan_of(model_of("", 0.02)).spreads);
  EXPECT_FALSE(plan_of(model_of("", 0.4)).spreads);
}

}  // namespace
}  // namespace weft
