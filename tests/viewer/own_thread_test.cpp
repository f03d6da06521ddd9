// The simulation's own thread: it begins the frames that are owed while the window paints. The frames and
// their bits are those of `simulate`, what is shown is one frame's state, and whoever asks changes nothing.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "gpu/buffer.h"
#include "gpu/commands.h"
#include "gpu_fixture.h"
#include "model/measures.h"
#include "sim/host_drawn.h"
#include "sim/native_simulation.h"
#include "viewer/running_scene.h"
#include "viewer/thread_order.h"

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point moment) {
  return std::chrono::duration<double>(Clock::now() - moment).count();
}

void sleep_s(double wall_s) { std::this_thread::sleep_for(std::chrono::duration<double>(wall_s)); }

class OwnThreadTest : public test::GpuTest {
 protected:
  static constexpr double kFrame_s = 1.0 / 60.0;
  OwnThreadTest()
      : model_(build_model(load_scene(find_scene("1"), {{"cloth.resolution=32"}}).scene)),
        solver_(find_solver("leapfrog")) {}

  std::unique_ptr<HostSimulation> native() const { return make_native_simulation(model_, solver_, "f32"); }
  std::unique_ptr<HostDrawnSimulation> drawn() const { return draw_host_simulation(device(), native()); }
  OwedFrames owed(const Simulation& of, double frames, double period_s = 3600.0) const {
    return {kFrame_s, of.plan().substeps, period_s, frames};
  }
  /// What a picture made now would read.
  std::vector<glm::vec4> shown(const DrawnSimulation& simulation) const {
    const VkDeviceSize bytes = model_.grid.count() * sizeof(glm::vec4);
    gpu::Buffer copy(device(), "copy", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback);
    device().run_once([&](VkCommandBuffer commands) {
      const VkBufferCopy region{0, 0, bytes};
      vkCmdCopyBuffer(commands, simulation.draw_buffers().position, copy.handle(), 1, &region);
    });
    std::vector<glm::vec4> position(model_.grid.count());
    copy.read(std::as_writable_bytes(std::span(position)));
    return position;
  }

  Model model_;
  const Solver& solver_;
};

// So many frames as are owed, none before its time, and further ones without anybody asking again.
TEST_F(OwnThreadTest, BeginsWhatIsOwedAndNoMore) {
  const auto simulation = drawn();
  simulation->go_on(owed(*simulation, 3.0));
  const Clock::time_point began = Clock::now();
  while (simulation->time_s() < 2.9 * kFrame_s && seconds_since(began) < 20.0) sleep_s(0.002);
  sleep_s(0.03);
  EXPECT_EQ(simulation->time_s(), 3.0 * kFrame_s);
  FramesDone done = simulation->go_on(owed(*simulation, 3.0));
  EXPECT_EQ(done.frames, 3u);
  EXPECT_FALSE(done.under_way);
  EXPECT_GT(done.computed_ms, 0.0);
  EXPECT_EQ(simulation->go_on(owed(*simulation, 0.0)).frames, 0u) << "what was told is not told again";
  sleep_s(0.03);
  EXPECT_EQ(simulation->time_s(), 3.0 * kFrame_s) << "the next one is owed in an hour";
  // 0.25 s of wall time at 5 ms a frame, whoever looks: then the thread rests.
  simulation->go_on(owed(*simulation, 0.0, 0.005));
  sleep_s(0.05);
  EXPECT_TRUE(all_finite(simulation->read()));
  const Clock::time_point later = Clock::now();
  while (simulation->time_s() < 52.9 * kFrame_s && seconds_since(later) < 20.0) sleep_s(0.005);
  sleep_s(0.03);
  done = simulation->stay();
  EXPECT_EQ(done.frames, 50u);
  EXPECT_EQ(std::lround(simulation->time_s() / kFrame_s), 53);
}

// Nobody may see half a frame: each picture's positions are the bits of one frame's end. Eight frames more
// are owed at each look, so that there are several looks however fast frames are and however slow looks.
TEST_F(OwnThreadTest, WhatIsShownIsOneFramesState) {
  constexpr int kFrames = 40, kOwedALook = 8;
  std::vector<State> at_end;
  const auto reference = native();
  at_end.push_back(reference->read());
  const auto simulation = drawn();
  for (int frame = 0; frame < kFrames; ++frame) {
    reference->advance(kFrame_s, reference->plan().substeps);
    at_end.push_back(reference->read());
  }
  double owed_frames = 0.0;
  int looks = 0;
  long latest = 0;
  for (const Clock::time_point began = Clock::now(); latest < kFrames && seconds_since(began) < 60.0;
       ++looks) {
    if (kOwedALook * looks < kFrames) owed_frames += kOwedALook;
    owed_frames -= simulation->go_on(owed(*simulation, owed_frames)).frames;
    simulation->show_latest(0.01);
    const long frame = std::lround(simulation->shown_time_s() / kFrame_s);
    ASSERT_GE(frame, latest);
    ASSERT_NEAR(simulation->shown_time_s(), static_cast<double>(frame) * kFrame_s, 1e-9);
    latest = frame;
    const std::vector<glm::vec4> picture = shown(*simulation);
    const State& expected = at_end.at(static_cast<std::size_t>(frame));
    std::size_t different = 0;
    for (std::size_t k = 0; k < picture.size(); ++k)
      different += glm::vec3(picture[k]) != glm::vec3(expected.position[k]) ? 1 : 0;
    ASSERT_EQ(different, 0u) << "frame " << frame;
  }
  EXPECT_EQ(latest, kFrames);
  EXPECT_GE(looks, kFrames / kOwedALook);
  EXPECT_EQ(state_hash(simulation->read()), state_hash(at_end.back()));
}

// A picture may still read a simulation's buffers when that one ends; the validation layer would tell.
TEST_F(OwnThreadTest, EndsAfterThePicturesThatReadIt) {
  auto simulation = drawn();
  const VkDeviceSize bytes = model_.grid.count() * sizeof(glm::vec4);
  gpu::Buffer copy(device(), "copy", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback);
  gpu::Commands commands(device(), "picture");
  commands.record([&](VkCommandBuffer handle) {
    const VkBufferCopy region{0, 0, bytes};
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT;
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    VkDependencyInfo order{};
    order.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    order.memoryBarrierCount = 1;
    order.pMemoryBarriers = &barrier;
    for (int k = 0; k < 300; ++k) {  // long enough to be under way
      vkCmdCopyBuffer(handle, simulation->draw_buffers().position, copy.handle(), 1, &region);
      vkCmdPipelineBarrier2(handle, &order);
    }
  });
  const std::uint64_t picture = device().submit(commands.handle());
  simulation.reset();
  EXPECT_GE(device().completed(), picture);
}

// A person looks, a frame is cut by a stop, single frames follow: the state is that of as many frames.
TEST_F(OwnThreadTest, AWindowsRunHasTheBitsOfSimulate) {
  RunningScene running(device(), {{"cloth.resolution=32"}}, "1", {}, ComputeOn::native);
  Clock::time_point latest = Clock::now();
  for (int turn = 0; turn < 25; ++turn) {
    sleep_s(turn % 5 == 4 ? 0.045 : 0.01);  // pictures of two lengths
    const Clock::time_point now = Clock::now();
    running.advance(std::chrono::duration<double>(now - latest).count(), 0.02);
    latest = now;
    if (turn == 7) running.watch_next_frame();
    if (turn % 6 == 0) running.measure_now();
    EXPECT_LE(running.simulation().shown_time_s(), running.simulation().time_s());
  }
  EXPECT_GT(running.figures().frame_ms, 0.0);
  const auto watched = running.take_watched();
  ASSERT_TRUE(watched);
  EXPECT_NEAR(watched->after.time_s - watched->before.time_s, kFrame_s, 1e-9);
  running.set_paused(true);
  EXPECT_EQ(running.simulation().shown_time_s(), running.simulation().time_s()) << "what stands is shown";
  const double stood_s = running.simulation().time_s();
  sleep_s(0.03);
  EXPECT_EQ(running.simulation().time_s(), stood_s);
  running.step();
  do running.advance(0.0, 0.05);
  while (running.mid_frame());
  const long frames = std::lround(running.simulation().time_s() / kFrame_s);
  EXPECT_GT(frames, 5);
  EXPECT_NEAR(running.simulation().time_s(), static_cast<double>(frames) * kFrame_s, 1e-9);
  const auto reference = native();
  for (long frame = 0; frame < frames; ++frame) reference->advance(kFrame_s, reference->plan().substeps);
  EXPECT_EQ(state_hash(running.simulation().read()), state_hash(reference->read()));
}

// The pacer's promise with a thread beside it: a picture that takes 70 ms costs no simulated time. A cloth of
// 16 x 16 takes about 0.2 ms a frame; a machine that is busy may lose some of it, not half. Without that
// thread each picture would find one frame done: 17 ms of 70.
TEST_F(OwnThreadTest, ALongPictureCostsNoTime) {
  RunningScene running(device(), {{"cloth.resolution=16"}}, "1", {}, ComputeOn::native);
  Clock::time_point latest = Clock::now();
  const Clock::time_point began = latest;
  for (int picture = 0; picture < 12; ++picture) {
    sleep_s(0.07);
    const Clock::time_point now = Clock::now();
    running.advance(std::chrono::duration<double>(now - latest).count(),
                    1e-9);  // one frame at most by itself
    latest = now;
  }
  const double wall_s = seconds_since(began);
  EXPECT_GT(running.simulation().time_s(), 0.5 * wall_s - 2.0 * kFrame_s) << "of " << wall_s << " s";
  EXPECT_LT(running.simulation().time_s(), wall_s + 2.0 * kFrame_s);
}

// Symplectic growth of at least e^0.6 a step beyond the bound, as in running_scene_test.
TEST_F(OwnThreadTest, ADivergedFrameIsTheLast) {
  RunningScene running(device(), {{"cloth.resolution=32", "solver.substeps=8", "material.membrane=20000"}},
                       "1", {}, ComputeOn::native);
  for (int turn = 0; turn < 2000 && !running.diverged(); ++turn) {
    running.advance(0.02, 0.01);
    sleep_s(0.002);
  }
  ASSERT_TRUE(running.diverged());
  const State shown = running.simulation().read();
  EXPECT_TRUE(all_finite(shown));
  EXPECT_EQ(running.simulation().shown_time_s(), shown.time_s);
  running.advance(0.1, 0.01);
  sleep_s(0.02);
  EXPECT_EQ(running.simulation().time_s(), shown.time_s) << "a scene that diverged stands still";
}

// Threads that come later draw: they give way, those that were there do not.
TEST(ThreadOrder, OnlyNewThreadsArePutBehind) {
  const std::vector<int> before = threads_now();
  if (before.empty()) GTEST_SKIP() << "this system does not list threads";
  std::atomic<bool> done = false;
  std::thread drawing([&] {
    while (!done) sleep_s(0.001);
  });
  const std::vector<int> after = threads_now();
  EXPECT_EQ(after.size(), before.size() + 1);
  EXPECT_EQ(put_behind(before), 1);
  for (const int thread : after) {
    const bool old = std::ranges::find(before, thread) != before.end();
    EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(thread)),
              old ? getpriority(PRIO_PROCESS, 0) : kBehindNice);
  }
  done = true;
  drawing.join();
}

}  // namespace
}  // namespace weft
