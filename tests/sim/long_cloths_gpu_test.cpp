// Several cloths on the device with every other solver and precision: the mirrors' bits.
#include "cloths_fixture.h"

namespace weft::test {
namespace {

class LongClothsGpuTest : public ClothsGpu {};

TEST_F(LongClothsGpuTest, equal_their_mirrors_with_every_solver_and_precision) {
  equal_their_mirrors("leapfrog", "f64", kLayers + kAir);
  equal_their_mirrors("leapfrog", "f32k", kAir);
  equal_their_mirrors("xpbd", "f64", "");
  // All but explicit Euler, which blows up with one cloth, too.
  for (const char* solver : {"symplectic-euler", "velocity-verlet", "verlet", "trapezoid", "rk4"})
    equal_their_mirrors(solver, "f32", "");
}

}  // namespace
}  // namespace weft::test
