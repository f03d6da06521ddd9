// Capsules, boxes, meshes, a tilted floor and the air on the device: the mirrors' bits.
#include "collider_fixture.h"

namespace weft::test {
namespace {

TEST_F(ColliderGpuTest, all_at_once_equal_their_mirrors) {
  const std::string mesh_alone = kMesh.substr(kMesh.find("[[meshes]]"));
  equals_its_mirror(kSolids + mesh_alone + kWind, "leapfrog", "f32", "mesh_contact");
}

}  // namespace
}  // namespace weft::test
