// Colliders and air on the device, each by itself, with every solver and precision that has them: the
// mirrors' bits.
#include "collider_fixture.h"

namespace weft::test {
namespace {

TEST_F(ColliderGpuTest, solids_equal_their_mirror) {
  equals_its_mirror(kSolids, "leapfrog", "f32", "solid_contact");
  equals_its_mirror(kSolids, "leapfrog", "f64", "solid_contact");
  equals_its_mirror(kSolids, "xpbd", "f32", "solid_contact");
}

TEST_F(ColliderGpuTest, meshes_equal_their_mirror) {
  equals_its_mirror(kMesh, "leapfrog", "f32", "mesh_contact");
  equals_its_mirror(kMesh, "leapfrog", "f64", "mesh_contact");
}

TEST_F(ColliderGpuTest, air_equals_its_mirror) {
  equals_its_mirror(kWind, "leapfrog", "f32", "aerodynamics");
  equals_its_mirror(kWind, "leapfrog", "f64", "aerodynamics");
  equals_its_mirror(kWind, "symplectic-euler", "f32", "aerodynamics");
  equals_its_mirror(kWind, "xpbd", "f32", "aerodynamics");
}

}  // namespace
}  // namespace weft::test
