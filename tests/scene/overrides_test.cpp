// `--set section.key=value` goes through the same table and checks as the file, and names itself as the
// place.
#include "scene/scene_text.h"

namespace weft {
namespace {

const char* const kScene = R"(
[cloth]
center = [0, 5, 0]
[material]
density = 0.5
[[pins]]
at = [0, 0]
[[spheres]]
center = [0, 0, 0]
radius = 0.25
)";

TEST(Overrides, ChangeKeysInOrder) {
  const Scene scene =
      read(kScene, {"material.density=0.3", "cloth.resolution = 40", "material.density=0.4"}).scene;
  EXPECT_EQ(scene.material.density_kg_m2, 0.4);
  EXPECT_EQ(scene.cloth.resolution, 40u);
  expect_refused(kScene, {"cloth.resolution is 40.0; ", "a whole number"}, {"cloth.resolution=4e1"});
  EXPECT_EQ(read(kScene, {"cloth.center=[1, 2.5, 3]"}).scene.cloth.center_m, glm::dvec3(1.0, 2.5, 3.0));
}

TEST(Overrides, WordsNeedNoQuotes) {
  EXPECT_EQ(read(kScene, {"solver.precision=f64"}).scene.solver.precision, "f64");
  EXPECT_EQ(read(kScene, {"solver.precision=\"f64\""}).scene.solver.precision, "f64");
  EXPECT_EQ(read(kScene, {"solver.substeps=7", "solver.substeps=auto"}).scene.solver.substeps, 0u);
  EXPECT_EQ(read(kScene, {"title=A flag"}).scene.title, "A flag");
}

TEST(Overrides, AddSections) {
  EXPECT_EQ(read(kScene, {"floor.height=-1"}).scene.floor->height_m, -1.0);
  EXPECT_EQ(read(kScene, {"gravity={}"}).scene.gravity->acceleration_m_s2, glm::dvec3(0.0, -9.81, 0.0));
  EXPECT_EQ(read(kScene, {"floor={height=-2, friction=0.5}"}).scene.floor->friction, 0.5);
  const Scene windy = read(kScene, {"wind.velocity=[0,0,3]", "air.drag=0.1"}).scene;
  EXPECT_EQ(windy.wind->velocity_m_s.z, 3.0);
}

TEST(Overrides, ReachListItemsAndAppend) {
  EXPECT_EQ(read(kScene, {"spheres.0.radius=0.3"}).scene.spheres.at(0).radius_m, 0.3);
  const Scene scene = read(kScene, {"pins.1.at=[1, 0]", "pins.1.radius=0.1", "pins.2.at=[1, 1]"}).scene;
  ASSERT_EQ(scene.pins.size(), 3u);
  EXPECT_EQ(scene.pins[1].radius_m, 0.1);
  EXPECT_EQ(scene.pins[2].at, glm::dvec2(1.0, 1.0));
  expect_refused(kScene, {"--set pins.2.at=[1, 0]", "there is 1", "0 to 1"}, {"pins.2.at=[1, 0]"});
  expect_refused(kScene, {"spheres.1.center is missing"}, {"spheres.1.radius=1"});
  expect_refused(kScene, {"pins is a list", "pins.0.key=value"}, {"pins.at=[0,0]"});
  expect_refused(kScene, {"pins is a list"}, {"pins.0=3"});
  expect_refused(kScene, {"pins is a list"}, {"pins.-1.at=[0,0]"});
  expect_refused(kScene, {"pins is a list"}, {"pins.99999999999999999999999.at=[0,0]"});
}

TEST(Overrides, SetItemsAndListsWhole) {
  const Scene added = read(kScene, {"spheres.1={center=[0,1,0], radius=0.2}"}).scene;
  ASSERT_EQ(added.spheres.size(), 2u);
  EXPECT_EQ(added.spheres[1].center_m.y, 1.0);
  EXPECT_EQ(read(kScene, {"spheres.0={radius=0.5}"}).scene.spheres.at(0).radius_m, 0.5);
  const Scene anew = read(kScene, {"spheres=[{center=[1,0,0], radius=1}, {center=[2,0,0], radius=2}]"}).scene;
  ASSERT_EQ(anew.spheres.size(), 2u);
  EXPECT_EQ(anew.spheres[1].radius_m, 2.0);
  EXPECT_TRUE(read(kScene, {"pins=[]"}).scene.pins.empty());
  expect_refused(kScene, {"spheres.0.radius is missing"}, {"spheres=[{center=[0,0,0]}]"});  // not the file's
  expect_refused(kScene, {"did you mean radius?"}, {"spheres.0={radus=1}"});
  expect_refused(kScene, {"there is 1", "0 to 1"}, {"spheres.2={radius=1}"});
  expect_refused(kScene, {"spheres is a list"}, {"spheres=[1, 2]"});
}

TEST(Overrides, NameThemselvesAsThePlace) {
  EXPECT_EQ(
      refusal(kScene, {"material.density=-1"}),
      "--set material.density=-1: material.density is -1; it must be 0.001 to 100, in kg/m² (cotton: 0.15)");
  expect_refused(kScene, {"--set wind.velocity=[0,0,3]: [wind] needs [air]"}, {"wind.velocity=[0,0,3]"});
  expect_refused(kScene, {"--set pins.0.radius=0: ", "must hold a particle"},
                 {"pins.0.radius=0", "pins.0.at=[0.001,0]"});
}

TEST(Overrides, RefuseWhatTheyCannotRead) {
  expect_refused(kScene, {"there is no '='", "section.key=value"}, {"material.density"});
  expect_refused(kScene, {"not a TOML value"}, {"material.density="});
  expect_refused(kScene, {"not a TOML value"}, {"material.density=.5.5"});
  expect_refused(kScene, {"not a TOML value"}, {"material.density=1\ncloth=2"});
  expect_refused(kScene, {"did you mean density?"}, {"material.densty=1"});
  expect_refused(kScene, {"did you mean material?"}, {"matrial.density=1"});
  expect_refused(kScene, {"is not a section"}, {"=1"});
  expect_refused(kScene, {"cloth is a section", "cloth.key=value"}, {"cloth=3"});
  expect_refused(kScene, {"is not a key of [cloth]"}, {"cloth.width.x=3"});
  expect_refused(kScene, {"\"vertical\" or \"horizontal\""}, {"cloth.orientation=sideways"});
}

TEST(Overrides, APresetReplacesTheMaterialAndKeysOverrideIt) {
  const Scene scene = read(kScene, {"material.bend=3e-6", "material.preset=denim"}).scene;
  EXPECT_EQ(scene.material.preset, "denim");
  EXPECT_EQ(scene.material.density_kg_m2, 0.324);  // not the file's 0.5
  EXPECT_EQ(scene.material.bend_n_m, 3e-6);        // wherever it stands among the --set
  expect_refused(kScene, {"--set material.preset=denin", "did you mean denim?"}, {"material.preset=denin"});
  expect_refused(kScene, {"it must be a word in quotes"}, {"material.preset=3"});
}

}  // namespace
}  // namespace weft
