// What the accuracy panel shows: the measured error between points, the live estimate, the history.
#include "study/live.h"

#include <gtest/gtest.h>

#include "model/measures.h"
#include "study_cloths.h"

namespace weft::study {
namespace {

Point measured(std::uint32_t substeps, double error_m, bool diverged = false) {
  Point point = point_of(substeps, error_m, diverged);
  point.setting = {"leapfrog", "f32", substeps};
  return point;
}

TEST(MeasuredError, IsInterpolatedOnTheLogarithmicLine) {
  // Second order: between 10 substeps with 1e-2 and 40 with 6.25e-4, 20 have 2.5e-3.
  const std::vector<Point> points{measured(5, 1.0, true), measured(10, 1e-2), measured(40, 6.25e-4)};
  EXPECT_NEAR(*measured_error_m(points, {"leapfrog", "f32", 20}), 2.5e-3, 1e-15);
  EXPECT_EQ(*measured_error_m(points, {"leapfrog", "f32", 40}), 6.25e-4);
  EXPECT_FALSE(measured_error_m(points, {"leapfrog", "f32", 41}));
  EXPECT_FALSE(measured_error_m(points, {"leapfrog", "f32", 7}));  // beside one that diverged
  EXPECT_FALSE(measured_error_m(points, {"leapfrog", "f64", 20}));
  EXPECT_FALSE(measured_error_m(points, {"rk4", "f32", 20}));
}

TEST(LiveError, IsTheDistanceToTheFrameWithTwiceTheSubsteps) {
  const Model model = build_model(small_scene());
  const double frame_s = model.scene.solver.frame_s;
  const Setting setting{"leapfrog", "f64", 20};
  const State before = start_state(model);
  const State after = run_on_cpu(model, setting, frame_s, {}).back();
  const State finer = run_on_cpu(model, {"leapfrog", "f64", 40}, frame_s, {}).back();
  LiveError live({.device = nullptr, .label = "CPU reference"}, model, setting);
  EXPECT_FALSE(live.go_on());
  live.begin(before, after, frame_s);
  std::optional<double> error_m;
  while (live.under_way()) error_m = live.go_on();
  ASSERT_TRUE(error_m);
  EXPECT_NEAR(*error_m, rms_distance(after, finer), 1e-18);
  EXPECT_GT(*error_m, 0.0);
  EXPECT_GT(live.cost_ms(), 0.0);
}

TEST(History, KeepsTheLatestAndBeginsAnewAfterAReset) {
  const Model model = build_model(small_scene());
  State state = start_state(model);
  History history(3);
  for (int frame = 0; frame < 5; ++frame) {
    state.time_s = frame;
    history.add(model, state);
    history.add(model, state);  // the same instant counts once
  }
  ASSERT_EQ(history.samples().size(), 3u);
  EXPECT_EQ(history.samples().front().time_s, 2.0);
  EXPECT_EQ(history.samples().back().energy_j, energy(model, state).total());
  state.time_s = 0.5;
  history.add(model, state);
  EXPECT_EQ(history.samples().size(), 1u);
}

}  // namespace
}  // namespace weft::study
