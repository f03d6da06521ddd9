// [[cloths]]: what a further cloth says itself, what it takes from [cloth], and what it may not say.
#include <gtest/gtest.h>

#include "scene/grid_rule.h"
#include "scene_text.h"

namespace weft {
namespace {

constexpr const char* kTwo = "[cloth]\norientation = \"horizontal\"\nimperfection = 0.02\n[[cloths]]\n";

TEST(SceneCloths, TakeFromTheFirstWhatTheyDoNotSay) {
  const Scene scene = read(std::string(kTwo) +
                           "center = [1, 2, 3]\n[[cloths]]\ncenter = [4, 5, 6]\n"
                           "orientation = \"vertical\"\nimperfection = 0\n")
                          .scene;
  ASSERT_EQ(cloth_count(scene), 3u);
  EXPECT_EQ(cloth_of(scene, 0).center_m, glm::dvec3(0.0));
  EXPECT_EQ(cloth_of(scene, 1).center_m, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(cloth_of(scene, 1).orientation, Orientation::horizontal);
  EXPECT_EQ(cloth_of(scene, 1).imperfection_m, 0.02);
  EXPECT_EQ(cloth_of(scene, 2).orientation, Orientation::vertical);
  EXPECT_EQ(cloth_of(scene, 2).imperfection_m, 0.0);
  EXPECT_EQ(cloth_of(scene, 2).resolution, scene.cloth.resolution);
}

TEST(SceneCloths, MayNotHaveASizeOfTheirOwn) {
  for (const char* key : {"resolution = 20", "width = 2", "height = 0.5"})
    expect_refused(std::string(kTwo) + "center = [0, 1, 0]\n" + key + "\n",
                   {"scene.toml:6", "every cloth has the same size and resolution", "move it there"});
  expect_refused(std::string(kTwo) + "density = 1\n", {"\"density\" is not a key of [cloths]"});
  expect_refused(std::string(kTwo), {"cloths.0.center is missing"});
}

TEST(SceneCloths, AreHeldByPinsThatNameThem) {
  const std::string held = std::string(kTwo) + "center = [0, 1, 0]\n[[pins]]\nat = [0, 0]\ncloth = ";
  EXPECT_EQ(read(held + "1\n").scene.pins[0].cloth, 1u);
  expect_refused(held + "2\n", {"scene.toml:8", "pins.0.cloth is 2", "0 to 1"});
  expect_refused(held + "64\n", {"pins.0.cloth is 64", "0 to 63"});
}

TEST(SceneCloths, AreAtMost64) {
  std::string many = "[cloth]\n";
  for (int k = 0; k < 63; ++k) many += "[[cloths]]\ncenter = [0, 0, 1]\n";
  EXPECT_EQ(cloth_count(read(many).scene), 64u);
  expect_refused(many + "[[cloths]]\ncenter = [0, 0, 1]\n", {"there are 65 cloths", "at most 64"});
}

TEST(SceneCloths, AreWarnedOfWhereAnyStartsInACollider) {
  const std::string under = "[cloth]\ncenter = [0, 1, 0]\n[floor]\n[[cloths]]\ncenter = [0, 0.25, 0]\n";
  ASSERT_EQ(read(under).warnings.size(), 1u);
  EXPECT_TRUE(contains(read(under).warnings[0], "0.25 m below the floor")) << read(under).warnings[0];
}

}  // namespace
}  // namespace weft
