// A change that a thread prepares: the scene goes on meanwhile, nobody waits for it, and what comes of it is
// what a change has that is waited for.
#include "viewer/scene_change.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"
#include "gpu/commands.h"
#include "gpu_fixture.h"
#include "model/measures.h"
#include "viewer/running_scene.h"

namespace weft {
namespace {

class SceneChangeTest : public test::GpuTest, public testing::WithParamInterface<ComputeOn> {
 protected:
  static RunningScene scene_at(std::uint32_t resolution) {
    return RunningScene(device(), {{"cloth.resolution=" + std::to_string(resolution)}}, "1", {}, GetParam());
  }
  static Scene finer(const RunningScene& running, std::uint32_t resolution) {
    Scene next = running.scene();
    next.cloth.resolution = resolution;
    return next;
  }
  /// One turn of a window's loop.
  static bool turn(RunningScene& running) {
    running.advance(1.0 / 60.0, 0.002);
    return running.follow_change();
  }
  static void turn_until_done(RunningScene& running) {
    while (!turn(running)) {
    }
  }
};
std::string computed_on_name(const testing::TestParamInfo<ComputeOn>& tested) {
  return tested.param == ComputeOn::device ? "Device" : "Native";
}
INSTANTIATE_TEST_SUITE_P(On, SceneChangeTest, testing::Values(ComputeOn::device, ComputeOn::native),
                         computed_on_name);

// Paused, so that both carry the same state.
TEST_P(SceneChangeTest, EndsInTheBitsOfAChangeThatIsWaitedFor) {
  RunningScene waits = scene_at(24), goes_on = scene_at(24);
  for (RunningScene* running : {&waits, &goes_on}) {
    running->set_paused(true);
    running->step();
    for (int k = 0; k < 1000 && (running->simulation().time_s() < 0.9 / 60.0 || running->mid_frame()); ++k)
      running->advance(0.0, 0.05);
  }
  waits.apply(finer(waits, 40));
  goes_on.begin_change(finer(goes_on, 40));
  turn_until_done(goes_on);
  EXPECT_EQ(goes_on.model().grid.nx, 40u);
  EXPECT_EQ(state_hash(goes_on.simulation().read()), state_hash(waits.simulation().read()));
  Scene windy = goes_on.scene();
  windy.wind = WindSection{};
  windy.wind->velocity_m_s = {3.0, 0.0, 0.0};
  waits.apply(windy);
  goes_on.begin_change(windy);
  turn_until_done(goes_on);
  EXPECT_EQ(goes_on.figures().kept_plan, waits.figures().kept_plan);
  EXPECT_EQ(state_hash(goes_on.simulation().read()), state_hash(waits.simulation().read()));
}

// The cloth of before is shown and computed until the new one is there, however long that takes; what is
// asked for is known at once.
TEST_P(SceneChangeTest, TheSceneGoesOnMeanwhile) {
  RunningScene running = scene_at(64);
  const double before_s = running.simulation().time_s();
  running.begin_change(finer(running, 512));
  EXPECT_EQ(running.wanted().cloth.resolution, 512u);
  EXPECT_EQ(running.scene().cloth.resolution, 64u);
  while (running.simulation().time_s() <= before_s) running.advance(1.0 / 60.0, 0.002);
  const double reached_s = running.simulation().time_s();
  int turns = 0;
  for (; !turn(running); ++turns) {
    ASSERT_EQ(running.model().grid.nx, 64u);
    ASSERT_NE(running.simulation().draw_buffers().position, VkBuffer{});
  }
  // Three parts, of which one may end within a turn's patience whenever the thread is not asked to wait.
  EXPECT_GE(turns, 1) << "none waits for the whole change";
  EXPECT_EQ(running.model().grid.nx, 512u);
  EXPECT_GE(running.simulation().time_s(), reached_s) << "no moment is lost";
}

TEST_P(SceneChangeTest, AWrongOneLeavesTheSceneThatRuns) {
  RunningScene running = scene_at(24);
  Scene wrong = running.scene();
  wrong.cloth.width_m = -1.0;
  running.begin_change(wrong);
  EXPECT_THROW(turn_until_done(running), Error);
  EXPECT_FALSE(running.changing());
  EXPECT_EQ(running.wanted().cloth.width_m, running.scene().cloth.width_m);
  EXPECT_GT(running.scene().cloth.width_m, 0.0);
  running.begin_change(finer(running, 32));
  turn_until_done(running);
  EXPECT_EQ(running.model().grid.nx, 32u);
}

// Whatever comes next builds on it, or ends it.
TEST_P(SceneChangeTest, WhatFollowsKnowsOfIt) {
  RunningScene running = scene_at(24);
  running.begin_change(finer(running, 40));
  Scene next = running.wanted();
  next.material.membrane_n_m *= 1.5;
  running.apply(next);
  EXPECT_EQ(running.model().grid.nx, 40u);
  EXPECT_FALSE(running.changing());
  running.begin_change(finer(running, 24));
  running.reset();
  EXPECT_EQ(running.model().grid.nx, 24u) << "it was asked for before";
  running.begin_change(finer(running, 40));
  running.open("4");
  EXPECT_FALSE(running.changing());
  EXPECT_EQ(running.which(), "4");
  EXPECT_EQ(running.model().grid.nx, 24u) << "it was of another scene";
  running.begin_change(finer(running, 300));  // and one ends with the scene
}

/// Keeps the device's queue from going on until it is opened.
class Gate {
 public:
  explicit Gate(gpu::Device& device) : device_(device), commands_(device, "gate") {
    const VkEventCreateInfo info{VK_STRUCTURE_TYPE_EVENT_CREATE_INFO, nullptr, 0};
    gpu::check(vkCreateEvent(device.handle(), &info, nullptr, &event_), "an event");
    commands_.record([&](VkCommandBuffer commands) {
      vkCmdWaitEvents(commands, 1, &event_, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0,
                      nullptr, 0, nullptr, 0, nullptr);
    });
    device.submit(commands_.handle());
  }
  ~Gate() {
    open();
    device_.wait_idle();
    vkDestroyEvent(device_.handle(), event_, nullptr);
  }
  Gate(const Gate&) = delete;
  Gate& operator=(const Gate&) = delete;
  void open() { gpu::check(vkSetEvent(device_.handle(), event_), "to open the gate"); }

 private:
  gpu::Device& device_;
  gpu::Commands commands_;
  VkEvent event_ = VK_NULL_HANDLE;
};

// A window must be able to look at keys and mouse whatever its device does: here it does nothing at all, so
// that whoever waited for a part of a frame, or for the state, would never come back.
TEST_P(SceneChangeTest, NobodyWaitsForTheDevice) {
  if (GetParam() != ComputeOn::device) GTEST_SKIP() << "the device computes nothing there";
  RunningScene running = scene_at(64);
  Gate gate(device());
  for (int turns = 0; turns < 3; ++turns) {
    running.advance(1.0 / 60.0, 0.002);
    EXPECT_FALSE(running.showable()) << "what is drawn is not one moment's";
  }
  EXPECT_EQ(running.figures().expected_ms, 0.0) << "nothing has come of the part yet";
  gate.open();
  while (!running.showable()) running.advance(0.0, 0.002);
  EXPECT_GT(running.figures().frame_ms + running.figures().expected_ms, 0.0);
}

}  // namespace
}  // namespace weft
