// Compensated positions against double down to microsecond steps; minutes, so only in the long run.
#include <gtest/gtest.h>

#include <cstdio>

#include "model/measures.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

/// A stiff cloth under tension: pinned all round, it vibrates and does not buckle.
Model drum() {
  Scene scene;
  scene.cloth.resolution = 13;
  scene.cloth.orientation = Orientation::horizontal;
  scene.cloth.center_m = {0.3, 0.7, 0.1};
  scene.material.damping_s = 2e-3;  // leapfrog's first-order term, so that its error stays above the last bit
  scene.material.damping_ratio_max = 1.0;
  scene.gravity = GravitySection{};
  scene.air = AirSection{0.1};
  const Model model = build_model(scene);
  return pin_where(model, [&](std::uint32_t i, std::uint32_t j) {
    return i == 0 || j == 0 || i + 1 == model.grid.nx || j + 1 == model.grid.ny;
  });
}

// Below is float's own last bit: coefficients and the springs' ends are floats, which leaves 3e-8 m however
// small the step. Plain float sums are off by 2e-5 m at 4 us.
TEST(Compensation, ReachesDoublesErrorDownToFourMicroseconds) {
  const Model model = drum();
  const State start = start_state(model);
  const auto end = [&](const char* solver, const char* precision, std::uint32_t n) {
    return run_frames(model, start, solver, precision, 12, 1.0 / 60, n);
  };
  const State truth = end("rk4", "f64", 1200);
  for (const std::uint32_t n : {533u, 1067u, 2083u, 4167u}) {
    const double f32_m = rms_distance(end("leapfrog", "f32", n), truth);
    const double f32k_m = rms_distance(end("leapfrog", "f32k", n), truth);
    const double f64_m = rms_distance(end("leapfrog", "f64", n), truth);
    std::printf("  h = %.1f us: f32 %.2g, f32k %.2g, f64 %.2g m\n", 1e6 / 60 / n, f32_m, f32k_m, f64_m);
    EXPECT_LE(f32k_m, 2 * f64_m) << n;
    if (n > 2000) {
      EXPECT_GE(f32_m, 10 * f32k_m) << n;
    }
  }
}

}  // namespace
}  // namespace weft
