// What double is for, on the device: RK4 at the leapfrog's automatic count. A minute on a software device, so
// only in the long run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "gpu_fixture.h"
#include "model/measures.h"
#include "scenes.h"
#include "sim/gpu_simulation.h"

namespace weft::test {
namespace {

class LongDouble : public GpuTest {};

// The target of the work-precision scene: at most 1e-7 m from its own refinement at any frame of half a
// second. In float rounding alone is more than that, so this cannot pass by luck.
TEST_F(LongDouble, runge_kutta_is_within_1e_minus_7_m_of_its_refinement) {
  if (!device().info().float64) GTEST_SKIP() << device().info().name << " has no float64";
  const Solver& rk4 = find_solver("rk4");
  const auto model_in = [](const char* precision, const auto& substeps) {
    return scene_model(WEFT_SOURCE_DIR "/tests/physics/reference/work-precision.toml",
                       {.set = {fmt::format("solver.precision={}", precision),
                                fmt::format("solver.substeps={}", substeps)}});
  };
  const std::uint32_t automatic = substeps_per_frame(model_in("f64", "\"auto\""), find_solver("leapfrog"));
  ASSERT_EQ(automatic, 157u);
  const auto in_double = GpuSimulation::create(device(), model_in("f64", automatic), rk4);
  const auto in_float = GpuSimulation::create(device(), model_in("f32", automatic), rk4);
  const auto truth = make_cpu_simulation(model_in("f64", 2 * automatic), rk4, "f64");
  double double_m = 0.0, float_m = 0.0;
  for (int frame = 0; frame < 30; ++frame) {
    truth->advance(1.0 / 60, 2 * automatic);
    in_double->advance(1.0 / 60, automatic);
    in_float->advance(1.0 / 60, automatic);
    const State expected = truth->read();
    double_m = std::max(double_m, rms_distance(in_double->read(), expected));
    float_m = std::max(float_m, rms_distance(in_float->read(), expected));
  }
  std::printf("  rk4 at %u substeps: f64 %.3g m, f32 %.3g m\n", automatic, double_m, float_m);
  EXPECT_LE(double_m, 1e-7);
  EXPECT_GT(float_m, 1e-7);
}

}  // namespace
}  // namespace weft::test
