// The substep budget: what is said in slow motion, and when XPBD takes over and gives back. Without a window.
#include "viewer/substep_budget.h"

#include <gtest/gtest.h>

#include "viewer/pacing.h"

namespace weft {
namespace {

constexpr std::uint64_t kParticles = 4096;

Pace slow_pace(double factor, std::uint32_t needed) { return {1.0, factor, true, needed}; }

// 0.31 of real time with 3600 substeps a frame: 0.31 * 3600 = 1116 got done in a frame's time.
TEST(SubstepBudget, IsWhatGotDoneInAFramesTime) {
  EXPECT_EQ(substep_budget(slow_pace(0.31, 3600)), 1116u);
  EXPECT_EQ(slow_motion_text(slow_pace(0.31, 3600)), "0.31 x real time: 3600 substeps needed, budget 1116");
  EXPECT_EQ(slow_motion_text(slow_pace(0.0012, 500)), "0.0012 x real time: 500 substeps needed, budget 0");
  // Asked for half speed, a frame has twice the time: 0.31 / 0.5 of what is needed fits.
  EXPECT_EQ(substep_budget({0.5, 0.31, true, 3600}), 2232u);
  EXPECT_EQ(substep_budget({1.0, 1.0, false, 157}), 157u);
  EXPECT_EQ(slow_motion_text({1.0, 1.0, false, 157}), "") << "where the pace holds there is nothing to say";
}

// The pacer's measured second gives the factor: one frame of 1/60 s in each picture of 1/20 s is a third.
TEST(SubstepBudget, FollowsTheMeasuredPace) {
  Pacer pacer(1.0 / 60.0);
  for (int picture = 0; picture < 60; ++picture) {
    pacer.elapse(1.0 / 20.0);
    if (pacer.frame_due()) pacer.frame_done();
    pacer.give_up_rest();
  }
  const Pace pace{pacer.speed(), pacer.real_time_factor(), pacer.slow_motion(), 900};
  EXPECT_TRUE(pace.slow);
  EXPECT_NEAR(substep_budget(pace), 300, 20);
}

TEST(XpbdStandIn, NeverActsUnasked) {
  XpbdStandIn stand_in;
  EXPECT_FALSE(stand_in.look({}, slow_pace(0.01, 100000), kParticles, 0));
  EXPECT_EQ(stand_in.text(0.1), "");
}

TEST(XpbdStandIn, TakesOverWhenAllowedAndTooSlow) {
  Scene scene;
  scene.solver.precision = "f32k";
  scene.solver.substeps = 3600;
  XpbdStandIn stand_in;
  stand_in.allow(true);
  EXPECT_FALSE(stand_in.look(scene, {1.0, 1.0, false, 3600}, kParticles, 0)) << "the pace holds";
  const auto next = stand_in.look(scene, slow_pace(0.31, 3600), kParticles, 0);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->solver.name, "xpbd");
  EXPECT_EQ(next->solver.substeps, 0u);
  EXPECT_EQ(next->solver.precision, "f32") << "xpbd has no compensated form";
  EXPECT_EQ(stand_in.text(0.123),
            "xpbd in place of leapfrog: 3600 substeps needed, budget 1116; largest stretch 12.3 %");
  EXPECT_FALSE(stand_in.look(*next, slow_pace(0.5, 20), kParticles, 3600)) << "it stays";
}

// 1116 substeps fitted: four fifths of them, 892, bring the solver back; the same work at four times the
// particles is a quarter of the substeps.
TEST(XpbdStandIn, GivesBackWhenTheOwnSolverFitsAgain) {
  for (const auto& [particles, fits] : {std::pair{kParticles, 892u}, std::pair{4 * kParticles, 223u}}) {
    XpbdStandIn stand_in;
    stand_in.allow(true);
    const auto xpbd = stand_in.look({}, slow_pace(0.31, 3600), kParticles, 0);
    ASSERT_TRUE(xpbd);
    EXPECT_FALSE(stand_in.look(*xpbd, {}, particles, fits + 1));
    const auto back = stand_in.look(*xpbd, {}, particles, fits);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->solver.name, "leapfrog");
    EXPECT_FALSE(stand_in.active());
  }
}

TEST(XpbdStandIn, GivesBackAtOnceWhenForbidden) {
  Scene scene;
  scene.solver.name = "velocity-verlet";
  scene.solver.substeps = 500;
  XpbdStandIn stand_in;
  stand_in.allow(true);
  auto xpbd = stand_in.look(scene, slow_pace(0.5, 500), kParticles, 0);
  ASSERT_TRUE(xpbd);
  xpbd->material.membrane_n_m = 77.0;  // edited meanwhile: the edit stays
  stand_in.allow(false);
  const auto back = stand_in.look(*xpbd, {}, kParticles, 500);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->solver.name, "velocity-verlet");
  EXPECT_EQ(back->solver.substeps, 500u);
  EXPECT_EQ(back->material.membrane_n_m, 77.0);
}

TEST(XpbdStandIn, LeavesASolverAloneThatTheUserChose) {
  XpbdStandIn stand_in;
  stand_in.allow(true);
  auto scene = stand_in.look({}, slow_pace(0.5, 500), kParticles, 0);
  ASSERT_TRUE(scene);
  scene->solver.name = "rk4";
  EXPECT_FALSE(stand_in.look(*scene, {}, kParticles, 1)) << "it is not put back over the choice";
  EXPECT_FALSE(stand_in.active());
}

TEST(XpbdStandIn, DoesNotDropAnEffectThatXpbdLacks) {
  Scene scene;
  scene.self_collision = SelfCollisionSection{0.004};
  XpbdStandIn stand_in;
  stand_in.allow(true);
  EXPECT_FALSE(stand_in.look(scene, slow_pace(0.1, 5000), kParticles, 0));
  EXPECT_EQ(why_no_stand_in(scene), "it has no self-collision");
}

// Of the 16.7 ms of a 60 Hz frame, at half the speed of 33.3 ms.
TEST(SubstepBudget, SaysWhatAFrameTakesOfItsTime) {
  EXPECT_EQ(share_of_time_text(11.5, 1e3 / 60.0), "69 % of the time");
  EXPECT_EQ(share_of_time_text(11.0, 2e3 / 60.0), "33 % of the time");
  EXPECT_EQ(share_of_time_text(40.0, 1e3 / 60.0), "240 % of the time");
  EXPECT_EQ(share_of_time_text(0.0, 1e3 / 60.0), "") << "nothing is known yet";
}

}  // namespace
}  // namespace weft
