// The accuracy panel's matter on a device, without a window: the live estimate, the choice that is applied,
// a study in the background, and that nothing is left when it closes.
#include "viewer/accuracy.h"

#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "model/measures.h"
#include "viewer/studied_cloth.h"

namespace weft {
namespace {

class AccuracyTest : public test::GpuTest {
 protected:
  RunningScene open() { return RunningScene(device(), {}, file_); }
  static std::string label() { return device().info().label(); }
  static void one_frame(RunningScene& running) {
    const double time_s = running.simulation().time_s();
    running.set_paused(true);
    running.step();
    while (running.mid_frame() || running.simulation().time_s() == time_s) running.advance(0.0, 0.05);
  }

  test::ScratchCache cache_;
  std::string file_ = test::small_scene_file(cache_.folder());
};

TEST_F(AccuracyTest, AWatchedFrameHasBothEnds) {
  RunningScene running = open();
  one_frame(running);
  EXPECT_FALSE(running.take_watched()) << "nobody asked";
  const std::uint64_t before = state_hash(running.simulation().read());
  running.watch_next_frame();
  one_frame(running);
  const std::uint64_t after = state_hash(running.simulation().read());
  one_frame(running);
  const auto frame = running.take_watched();
  ASSERT_TRUE(frame);
  EXPECT_EQ(state_hash(frame->before), before);
  EXPECT_EQ(state_hash(frame->after), after);
  EXPECT_EQ(frame->frame_s, running.scene().solver.frame_s);
  EXPECT_FALSE(running.take_watched()) << "once";
  running.watch_next_frame();
  one_frame(running);
  Scene other = running.scene();
  other.cloth.resolution = 20;
  running.apply(other);
  EXPECT_FALSE(running.take_watched()) << "the ends of another cloth";
}

TEST_F(AccuracyTest, TheLiveErrorIsOneFrameAgainstTwiceTheSubsteps) {
  RunningScene running = open();
  for (int k = 0; k < 10; ++k) one_frame(running);
  LiveWatch watch;
  const auto begun = std::chrono::steady_clock::now();
  while (!watch.frame_error() && std::chrono::steady_clock::now() - begun < std::chrono::seconds(30)) {
    watch.follow(running);
    if (!watch.frame_error()) one_frame(running);
  }
  ASSERT_TRUE(watch.frame_error());
  // The same by hand: from that frame's start, with the running number of substeps and with twice as many.
  const double end_s = watch.frame_error()->time_s, frame_s = running.scene().solver.frame_s;
  const std::uint32_t n = running.simulation().plan().substeps;
  EXPECT_EQ(watch.frame_error()->substeps, n);
  RunningScene again = open();
  while (again.simulation().time_s() < end_s - 1.5 * frame_s) one_frame(again);
  const State start = again.simulation().read();
  one_frame(again);
  const State coarse = again.simulation().read();
  EXPECT_NEAR(coarse.time_s, end_s, 1e-9);
  Scene fine = again.scene();
  fine.solver.substeps = 2 * n;
  again.apply(fine);
  again.simulation().write(start);
  one_frame(again);
  EXPECT_NEAR(watch.frame_error()->error_m, rms_distance(coarse, again.simulation().read()), 1e-12);
  EXPECT_GT(watch.frame_error()->error_m, 0.0);
  EXPECT_GE(watch.history().samples().size(), 1u);
  EXPECT_GT(watch.bytes(), 0u);
  EXPECT_GT(watch.device_ms_per_s(), 0.0);
}

TEST_F(AccuracyTest, ClosedItHoldsNothing) {
  RunningScene running = open();
  one_frame(running);
  gpu::Allocator& allocator = device().allocator();
  const std::uint64_t count = allocator.live_count(), bytes = allocator.live_bytes();
  {
    Accuracy accuracy;
    const auto begun = std::chrono::steady_clock::now();
    while (accuracy.watch().bytes() == 0 &&
           std::chrono::steady_clock::now() - begun < std::chrono::seconds(30)) {
      accuracy.follow(running);
      one_frame(running);
    }
    EXPECT_GT(allocator.live_bytes(), bytes) << "open it has a copy of the cloth";
    running.watch_next_frame();
  }
  running.stop_watching();
  one_frame(running);
  EXPECT_FALSE(running.take_watched()) << "no frame is read for a closed panel";
  EXPECT_EQ(allocator.live_count(), count);
  EXPECT_EQ(allocator.live_bytes(), bytes);
}

TEST_F(AccuracyTest, AWishChoosesOnceAndAHandTakesItBack) {
  RunningScene running = open();
  study::keep_study(running.scene(), test::hand_made_study(running.scene(), label()));
  Accuracy accuracy;
  accuracy.follow(running);
  ASSERT_NE(accuracy.study(), nullptr);
  EXPECT_FALSE(accuracy.wanted()) << "nothing is wished";
  accuracy.wish() = {.kind = WishKind::error, .error_m = 5e-4};
  const auto wanted = accuracy.wanted();
  ASSERT_TRUE(wanted);
  EXPECT_EQ(*wanted, (study::Setting{"leapfrog", "f32", 80}));
  Scene next = running.scene();
  set_setting(*wanted, next);
  running.apply(next);
  accuracy.follow(running);
  EXPECT_FALSE(accuracy.wanted()) << "it runs already";
  EXPECT_EQ(accuracy.setting(), *wanted);
  EXPECT_NEAR(accuracy.measured_error_m().value(), 2.5e-4, 1e-12);
  next.solver.substeps = 99;
  running.apply(next);
  accuracy.follow(running);
  EXPECT_FALSE(accuracy.wanted());
  EXPECT_EQ(accuracy.wish().kind, WishKind::by_hand);
  EXPECT_TRUE(accuracy.choice().line.empty());
  next.cloth.resolution = 19;
  running.apply(next);
  accuracy.follow(running);
  EXPECT_EQ(accuracy.study(), nullptr) << "no study of this resolution is kept";
}

// On a machine without a GPU native computes, and leaves rk4 to the reference, where the study timed it: the
// study that the wish was asked of stays, and the next wish is asked of it, too.
TEST_F(AccuracyTest, AChoiceThatAnotherComputesKeepsItsStudy) {
  RunningScene running(device(), {}, file_, {}, ComputeOn::native);
  const std::string native = running.bench().label;
  study::keep_study(running.scene(), test::hand_made_study(running.scene(), native));
  Accuracy accuracy;
  accuracy.follow(running);
  ASSERT_NE(accuracy.study(), nullptr);
  accuracy.wish() = {.kind = WishKind::error, .error_m = 1e-5};
  const auto wanted = accuracy.wanted();
  ASSERT_TRUE(wanted);
  ASSERT_EQ(wanted->solver, "rk4");
  Scene next = running.scene();
  set_setting(*wanted, next);
  running.apply(next);
  accuracy.follow(running);
  EXPECT_EQ(running.on_gpu(), nullptr);
  EXPECT_NE(running.why_not_native(), "") << "native has no rk4";
  EXPECT_NE(accuracy.study(), nullptr);
  EXPECT_EQ(running.bench().label, native);
}

TEST(StudyRun, EndsWithAKeptStudyOrSaysWhyNot) {
  const test::ScratchCache cache;
  Scene scene = load_scene(test::small_scene_file(cache.folder()), {}).scene;
  scene.cloth.resolution = 5;
  const auto finish = [](const StudyRun& run) {
    for (int k = 0; k < 6000 && !run.finished(); ++k) usleep(10000);
    return run.finished();
  };
  {
    StudyRun run("", false, scene, scene.solver.frame_s);
    ASSERT_TRUE(finish(run));
    EXPECT_EQ(run.failure(), "");
    EXPECT_EQ(run.progress().done, run.progress().total);
  }
  const auto kept = study::kept_study(scene, "CPU reference", scene.solver.frame_s);
  ASSERT_TRUE(kept);
  EXPECT_GT(kept->points.size(), 10u);
  scene.cloth.resolution = 65;
  StudyRun cancelled("", false, scene, 5.0);
  cancelled.cancel();
  ASSERT_TRUE(finish(cancelled));
  EXPECT_NE(cancelled.failure().find("cancelled"), std::string::npos) << cancelled.failure();
  EXPECT_FALSE(study::kept_study(scene, "CPU reference", 5.0));
  StudyRun nowhere("no-such-device", false, scene, 0.1);
  ASSERT_TRUE(finish(nowhere));
  EXPECT_NE(nowhere.failure().find("no-such-device"), std::string::npos) << nowhere.failure();
}

}  // namespace
}  // namespace weft
