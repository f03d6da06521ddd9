// Minutes on a software device: anisotropy, pins on spheres and that let go, tethers and tearing on the
// device: the mirrors' bits.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "validated_pass.h"

namespace weft::test {
namespace {

class LongTornGpu : public ValidatedPassTest {};

TEST_F(LongTornGpu, warp_and_weft_equal_their_mirrors) {
  for (const char* solver : {"leapfrog", "xpbd"}) {
    Scene scene = full_model("").scene;
    scene.material.membrane_warp_n_m = 3.0 * scene.material.membrane_n_m;
    scene.material.bend_weft_n_m = 2.0 * scene.material.bend_n_m + 1e-5;
    rows_of(build_model(scene), solver, "");
  }
}

TEST_F(LongTornGpu, pins_that_let_go_equal_their_mirrors) {
  for (const Solver* solver : solvers()) {
    const bool fails = solver->name == "euler";
    const Model model = full_model(kPinsThatLetGo + "[solver]\n" + (fails ? "substeps = 2000\n" : ""));
    EXPECT_GT(rows_of(model, solver->name.data(), "pin_release"), 0u) << solver->name;
  }
}

TEST_F(LongTornGpu, tearing_equals_its_mirrors_and_is_drawn) {
  for (const char* precision : {"f32", "f32k", "f64"}) {
    if (std::string(precision) == "f64" && !device().info().float64) continue;
    Scene scene = full_model(fmt::format("[solver]\nprecision = \"{}\"\n", precision)).scene;
    scene.tearing = TearingSection{0.04};
    const Model model = build_model(scene);
    const bool compensated = std::string(precision) == "f32k";
    EXPECT_GT(rows_of(model, "leapfrog", compensated ? "integrate_torn_compensated" : "integrate_torn"), 0u);
    const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
    EXPECT_NE(simulation->draw_buffers().torn_mesh, VK_NULL_HANDLE);
    EXPECT_EQ(simulation->bytes_allocated(), simulation->bytes_expected());
  }
}

/// The examples hold what they expect of themselves.
}  // namespace
}  // namespace weft::test
