// Time stamped for whole substeps is divided among their steps, and none is lost.
#include "sim/step_times.h"

#include <gtest/gtest.h>

#include <numeric>

#include "scenes.h"

namespace weft::test {
namespace {

/// Of leapfrog with a box: two steps in the substep, integrate and solid_contact, then the frame's end.
Plan two_steps() {
  const Model model = full_model("[[boxes]]\ncenter = [0, -9, 0]\nsize = [1, 1, 1]\n");
  return compile_plan(model, find_solver("leapfrog"));
}

double sum(const std::vector<double>& of) { return std::accumulate(of.begin(), of.end(), 0.0); }

TEST(StepTimes, ShareWhatSubstepsTookLikeTheUsualOnesAndLoseNothing) {
  const Plan plan = two_steps();
  StepTimes times(plan);
  times.add(run_of(plan.steps[0], 0, 0), 50.0);  // a frame's first substep is like no other
  times.add(run_of(plan.steps[1], 1, 0), 50.0);
  times.add(run_of(plan.steps[0], 0, 1), 3.0);
  times.add(run_of(plan.steps[1], 1, 1), 1.0);
  times.add(run_of(plan.steps[0], 0, 5), 40.0);
  times.add(run_of(plan.steps[2], 2, plan.substeps), 7.0);
  const std::vector<double> ms = times.result();
  EXPECT_DOUBLE_EQ(ms[0], 50.0 + 3.0 + 30.0);
  EXPECT_DOUBLE_EQ(ms[1], 50.0 + 1.0 + 10.0);
  EXPECT_DOUBLE_EQ(ms[2], 7.0);
  EXPECT_DOUBLE_EQ(sum(ms), 151.0);
}

TEST(StepTimes, ShareByDispatchesWhereNoUsualSubstepWasStamped) {
  const Plan plan = two_steps();
  StepTimes times(plan);
  times.add({}, 8.0);
  EXPECT_DOUBLE_EQ(times.result()[0], 4.0);
  EXPECT_DOUBLE_EQ(times.result()[1], 4.0);
  EXPECT_DOUBLE_EQ(sum(times.result()), 8.0);
}

TEST(StepTimes, StampShortFramesWholeAndLongOnesInParts) {
  const Plan plan = two_steps();
  for (const std::uint32_t stamped : {0u, 1u, 2u, 3u, 17u, 34u})
    EXPECT_EQ(run_of(plan.steps[1], 1, stamped).step, 1u) << stamped;
  for (const std::uint32_t whole : {4u, 16u, 18u, 33u})
    EXPECT_EQ(run_of(plan.steps[1], 1, whole).step, TimedRun::kSeveral) << whole;
}

}  // namespace
}  // namespace weft::test
