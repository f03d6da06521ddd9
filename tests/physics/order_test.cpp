// Orders of convergence, and how a run is cut into frames.
#include <gtest/gtest.h>

#include "core/error.h"
#include "model/measures.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

/// Undamped, without contact, smooth: 0.1 s of a small cloth that swings from two corners.
Model smooth_swing() {
  Scene scene;
  scene.cloth.resolution = 9;
  scene.cloth.orientation = Orientation::horizontal;
  scene.cloth.imperfection_m = 0.01;
  scene.material.membrane_n_m = 100.0;
  scene.material.bend_n_m = 1e-3;
  scene.material.damping_s = 0.0;
  scene.gravity = GravitySection{};
  scene.air = AirSection{0.1};
  scene.wind = WindSection{{0.5, 0, 3}, 0.5, 0.1};
  scene.pins = {{{0, 0}, 0.05}, {{1, 0}, 0.05}};
  return build_model(scene);
}

// Halving the step divides the error by 2^order. Air and a gusting wind are in: they must not spoil it.
TEST(Order, IsTheSolversOwn) {
  const Model model = smooth_swing();
  const State start = start_state(model);
  const State truth = run_frames(model, start, "rk4", "f64", 1, 0.1, 8000);
  for (const Solver* solver : solvers()) {
    double previous_m = 0.0;
    const std::uint32_t coarsest =
        solver->order == 1 ? 3200 : 200;  // explicit Euler must not have blown up yet
    for (const std::uint32_t n : {coarsest, 2 * coarsest, 4 * coarsest}) {
      const double error_m = rms_distance(run_frames(model, start, solver->name, "f64", 1, 0.1, n), truth);
      if (previous_m > 0.0) {
        EXPECT_NEAR(std::log2(previous_m / error_m), solver->order, 0.15) << solver->name << n;
      }
      previous_m = error_m;
    }
  }
}

TEST(Frames, CoverTheTimeExactly) {
  const double frame_s = 1.0 / 60;
  const FramePlan whole = frames_for(5.0, frame_s, 100);
  EXPECT_EQ(whole.whole, 300u);
  EXPECT_EQ(whole.rest_substeps, 0u);
  const FramePlan split = frames_for(0.31, frame_s, 100);  // 18.6 frames
  EXPECT_EQ(split.whole, 18u);
  EXPECT_NEAR(split.rest_s, 0.01, 1e-15);
  EXPECT_EQ(split.rest_substeps, 60u);
  const FramePlan tiny = frames_for(1e-4, frame_s, 3);
  EXPECT_EQ(tiny.whole, 0u);
  EXPECT_EQ(tiny.rest_substeps, 1u);
  const FramePlan none = frames_for(0.0, frame_s, 3);
  EXPECT_EQ(none.whole + none.rest_substeps, 0u);
}

// Ten minutes of frames added one by one end on the whole second: 36 000/60 is exact in double.
TEST(Frames, DoNotAddUpRoundOff) {
  double time_s = 0.0;
  for (int frame = 0; frame < 36000; ++frame) time_s = frame_end_s(time_s, 1.0 / 60.0);
  EXPECT_EQ(time_s, 600.0);
  EXPECT_EQ(frame_end_s(0.3, 0.01), 0.3 + 0.01);  // a short frame ends where it says
}

TEST(Simulation, CountsWhatItDoes) {
  const Model model = smooth_swing();
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  const FrameStats stats = simulation->advance(0.01, 7);
  EXPECT_EQ(stats.substeps, 7u);
  EXPECT_EQ(stats.dispatches, 12u);  // eight kicks, the normals, and the three that look for divergence
  EXPECT_EQ(stats.spring_evaluations, 8 * model.spring_count);
  EXPECT_DOUBLE_EQ(simulation->time_s(), 0.01);
  const auto rk4 = make_cpu_simulation(model, find_solver("rk4"), "f64");
  EXPECT_EQ(rk4->advance(0.01, 7).spring_evaluations, 28 * model.spring_count);
}

TEST(Simulation, RefusesAnUnknownPrecision) {
  const Model model = smooth_swing();
  try {
    make_cpu_simulation(model, find_solver("leapfrog"), "f16");
    FAIL() << "accepted";
  } catch (const Error& refused) {
    EXPECT_EQ(refused.code(), Exit::usage);
    EXPECT_NE(std::string(refused.what()).find("f32"), std::string::npos);
  }
}

TEST(Simulation, StatesSurviveWriteAndRead) {
  const Model model = smooth_swing();
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f64");
  State state = start_state(model);
  shake(state, 0.1, 1.0, 8);
  state.time_s = 3.0;
  simulation->write(state);
  EXPECT_EQ(simulation->read().position, state.position);
  EXPECT_EQ(simulation->read().velocity, state.velocity);
  EXPECT_EQ(simulation->time_s(), 3.0);
}

}  // namespace
}  // namespace weft
