// Precision f64 on the device: every pass and every solver against the double mirrors, what is drawn, and
// where it is refused.
#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/gpu_program.h"
#include "sim/gpu_simulation.h"
#include "sim/validate.h"

namespace weft::test {
namespace {

constexpr const char* kInDouble = "[solver]\nprecision = \"f64\"\nsubsteps = 150\n";

class DoubleTest : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (!IsSkipped() && !device().info().float64) GTEST_SKIP() << device().info().name << " has no float64";
  }
  static void expect_valid(const Model& model, const Solver& solver, const ValidationOptions& options) {
    const ValidationReport report = validate(device(), model, solver, options);
    EXPECT_GT(report.rows.size(), 10u);
    for (const ValidationRow& row : report.rows)
      EXPECT_TRUE(row.ok) << solver.name << ": " << row.check << ", " << row.state << ", " << row.buffer
                          << ": " << row.verdict << ", max " << row.max_abs << ", " << row.max_ulp << " ulp";
  }
};

// Software devices must be exact. Substeps of a 9000th of a second are no float: one that were rounded would
// show in every bit.
TEST_F(DoubleTest, every_solver_equals_its_mirrors) {
  const Model model = full_model(kInDouble);
  for (const Solver* solver : solvers())
    expect_valid(model, *solver, {.lockstep_substeps = 20, .lockstep_frames = 1});
}

TEST_F(DoubleTest, self_collision_equals_its_mirrors_with_layers_that_touch) {
  expect_valid(scene_model("5", {.set = {"cloth.resolution=24", "self_collision.thickness=0.03",
                                         "solver.precision=f64"}}),
               find_solver("leapfrog"), {.lockstep_frames = 1});
}

// The law for devices that round otherwise: what float loses on the same work, times 2^-29. What is exact
// passes it, a falsified constant does not, and no position may be off by a picometre.
TEST_F(DoubleTest, is_held_below_a_picometre_on_other_devices) {
  const Model model = full_model(kInDouble);
  const ValidationReport report =
      validate(device(), model, find_solver("leapfrog"), {.lockstep_frames = 1, .assume_inexact = true});
  EXPECT_TRUE(report.ok());
  double positions_m = 0;
  for (const ValidationRow& row : report.rows)
    if (row.buffer == "position_next" || row.buffer == "position")
      positions_m = std::max(positions_m, row.tolerance);
  EXPECT_GT(positions_m, 0.0);
  EXPECT_LT(positions_m, 1e-12);
  const ValidationReport wrong =
      validate(device(), model, find_solver("leapfrog"),
               {.perturb = "integrate.gravity", .lockstep_frames = 1, .assume_inexact = true});
  EXPECT_FALSE(wrong.ok());
}

// 1/3 m/s and tenths of metres: no float holds them.
TEST_F(DoubleTest, keeps_every_bit_of_a_state_that_is_written_and_placed) {
  const Model model = full_model(kInDouble);
  const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
  State state = start_state(model);
  for (std::size_t p = 0; p < state.position.size(); ++p) {
    state.position[p] += 0.1 * static_cast<double>(p);
    state.velocity[p] = glm::dvec3(static_cast<double>(p) / 3.0);
  }
  simulation->write(state);
  expect_same(simulation->read(), state, "written");
  const std::uint32_t pinned = 0;  // full_model's pin at (0, 0)
  ASSERT_EQ(model.relative_inverse_mass[pinned], 0.0);
  simulation->place(std::vector{PlacedParticle{pinned, {0.25f, 0.5f, 0.75f}, {1.0f, 2.0f, 3.0f}}});
  state.position[pinned] = {0.25, 0.5, 0.75};
  state.velocity[pinned] = {1, 2, 3};
  expect_same(simulation->read(), state, "placed");
}

TEST_F(DoubleTest, records_and_allocates_what_its_plan_says) {
  const Model model = full_model(kInDouble);
  for (const Solver* solver : solvers()) {
    const auto simulation = GpuSimulation::create(device(), model, *solver);
    const Plan& plan = simulation->plan();
    EXPECT_EQ(simulation->bytes_allocated(), plan.bytes()) << solver->name;
    EXPECT_EQ(simulation->advance(model.scene.solver.frame_s, plan.substeps).dispatches, plan.dispatches())
        << solver->name;
  }
}

// The other kernels read texels, which are floats.
TEST_F(DoubleTest, runs_the_direct_kernel_and_no_other) {
  const Model model = full_model(kInDouble);
  const auto made = [&](const std::string& kernel) {
    return GpuSimulation::create(device(), model, find_solver("leapfrog"), {.kernel = kernel});
  };
  for (const char* kernel : {"auto", "direct"})
    EXPECT_EQ(made(kernel)->kernel().kernel.kind, KernelKind::direct) << kernel;
  for (const char* kernel : {"texel", "strip", "bands"}) {
    try {
      made(kernel);
      ADD_FAILURE() << kernel << " was taken";
    } catch (const Error& refusal) {
      EXPECT_EQ(refusal.code(), Exit::usage);
      EXPECT_NE(std::string(refusal.what()).find("f64"), std::string::npos) << refusal.what();
    }
  }
}

TEST_F(DoubleTest, is_refused_by_a_device_without_float64_before_anything_is_allocated) {
  const ScopedEnvironment without("WEFT_WITHOUT_FLOAT64", "1");
  const auto narrow = make_device();
  try {
    GpuSimulation::create(*narrow, full_model(kInDouble), find_solver("leapfrog"));
    ADD_FAILURE() << "not refused";
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.code(), Exit::no_device);
    EXPECT_NE(std::string(refusal.what()).find("no device here has it"), std::string::npos) << refusal.what();
  }
  EXPECT_NO_THROW(GpuSimulation::create(*narrow, full_model(), find_solver("leapfrog")));
  expect_silence(*narrow);
}

}  // namespace
}  // namespace weft::test
