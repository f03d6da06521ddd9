// Moving pins and spheres on the device: the mirrors' bits, with every solver, precision and kernel.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "validated_pass.h"

namespace weft::test {
namespace {

class MovedPinsGpuTest : public ValidatedPassTest {};

/// Every effect, and two pins and a sphere that turn within the first frames.
Model moving_model(const std::string& solver_lines) {
  return full_model(R"(
[[spheres]]
radius = 0.15
keys = [{ time = 0, center = [-0.2, 0.9, 0.5] }, { time = 0.02, center = [-0.2, 0.9, 0.1] },
        { time = 0.03, center = [0, 0.9, 0.1] }]
[[pins]]
at = [1.0, 0.0]
radius = 0.1
keys = [{ time = 0.005, offset = [0, 0, 0] }, { time = 0.021, offset = [0.1, 0.3, -0.2] }]
[[pins]]
at = [0.9, 0.1]
radius = 0.1
keys = [{ time = 0.0, offset = [0, 0.01, 0] }, { time = 0.01, offset = [0, 0, 0.1] }]
[solver]
)" + solver_lines);
}

TEST_F(MovedPinsGpuTest, every_solver_equals_its_mirrors) {
  for (const Solver* solver : solvers()) {
    const bool fails = solver->name == "euler";
    const Model model = moving_model(fails ? "substeps = 2000\n" : "");
    EXPECT_GT(rows_of(model, solver->name.data(), "pin_place"), 0u) << solver->name;
  }
}

TEST_F(MovedPinsGpuTest, the_other_precisions_equal_their_mirrors) {
  for (const char* precision : {"f32k", "f64"}) {
    if (std::string(precision) == "f64" && !device().info().float64) continue;
    const Model model = moving_model(std::string("precision = \"") + precision + "\"\n");
    EXPECT_GT(rows_of(model, "leapfrog", "pin_place"), 0u) << precision;
  }
}

TEST_F(MovedPinsGpuTest, kernels_end_in_the_same_bits_and_bands_says_why_not) {
  const Model model = moving_model("");
  const Solver& solver = find_solver("leapfrog");
  State expected;
  for (const char* kernel : {"direct", "texel", "strip", "steal"}) {
    const auto simulation = GpuSimulation::create(device(), model, solver, {.kernel = kernel});
    for (int frame = 0; frame < 2; ++frame)
      simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
    if (expected.position.empty()) expected = simulation->read();
    expect_same(simulation->read(), expected, kernel);
  }
  EXPECT_THROW(GpuSimulation::create(device(), model, solver, {.kernel = "bands"}), Error);
}

// The pins' places are data: other keys rewrite rows, and no command is recorded anew.
TEST_F(MovedPinsGpuTest, other_keys_keep_the_plan) {
  const Model model = moving_model("");
  const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
  simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
  Scene next = model.scene;
  next.pins[1].keys = {{0.0, {0, 0, 0}}, {5.0, {0, 1, 0}}};
  const Model other = build_model(next);
  ASSERT_TRUE(simulation->adopt(other));
  simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
  const State now = simulation->read();
  const MovedParticle& held = *std::ranges::find(other.moved_particles, 0u, &MovedParticle::pin);
  EXPECT_NEAR(now.position[held.particle].y, held.anchor_m.y + now.time_s / 5.0, 2e-7);
  EXPECT_EQ(simulation->bytes_allocated(), simulation->bytes_expected());
}

}  // namespace
}  // namespace weft::test
