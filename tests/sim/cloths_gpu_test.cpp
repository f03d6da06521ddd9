// Several cloths on the device: the mirrors' bits; which kernels decline.
#include "cloths_fixture.h"
#include "sim/kernels.h"
#include "sim/native_simulation.h"

namespace weft::test {
namespace {

class ClothsGpuTest : public ClothsGpu {};

TEST_F(ClothsGpuTest, equal_their_mirrors) {
  equal_their_mirrors("leapfrog", "f32", kLayers + kAir);
  equal_their_mirrors("xpbd", "f32", "");
}

// What walks past the end of a cloth is for one cloth; the gathering kernels are for any number.
TEST_F(ClothsGpuTest, run_with_the_gathering_kernels_only) {
  const Model model = two_cloths("");
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  EXPECT_EQ(plan.sheet_rows, model.grid.ny);
  EXPECT_EQ(fitting_kernel_names(device(), plan), (std::vector<std::string>{"direct", "texel"}));
  EXPECT_EQ(native_lacks(model, find_solver("leapfrog"), "f32"), "");
}

}  // namespace
}  // namespace weft::test
