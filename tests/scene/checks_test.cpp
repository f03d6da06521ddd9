// Contradictions between keys are refused; starts that look like mistakes are warned of, with how much.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scene/grid_rule.h"
#include "scene/parameters.h"
#include "scene/scene_text.h"
#include "shared/params.h"

namespace weft {
namespace {

TEST(Checks, WindNeedsAirAndGustsNeedAPeriod) {
  expect_refused("[cloth]\n[wind]\nvelocity=[0,0,3]\n", {"scene.toml:2", "[wind] needs [air]", "drag = 0.1"});
  const std::string windy = "[cloth]\n[air]\ndrag=0.1\n[wind]\nvelocity=[0,0,3]\n";
  EXPECT_EQ(refusal(windy), "accepted");
  expect_refused(windy + "gust = 0.5\n", {"scene.toml:6: wind.gust is 0.5", "period = 2"});
  expect_refused(windy + "gust = 0.5\nperiod = 1e-4\n", {"0.001 s or more"});
  EXPECT_EQ(refusal(windy + "gust = 0.5\nperiod = 0.001\n"), "accepted");
}

// What is wrong later, in the model or the plan, names the same places; in the window items come and go.
TEST(Checks, PlacesGoWithTheirKeys) {
  Scene scene = parse_scene(
                    "[cloth]\n[[spheres]]\nradius = 1\ncenter = [0, 9, 0]\n[[spheres]]\nradius = 2\n"
                    "center = [0, 9, 0]\n[[pins]]\nat = [0, 0]\n",
                    "scene.toml", {{"spheres.1.friction=0.5"}})
                    .scene;
  EXPECT_EQ(place_of(scene, "spheres.0.radius"), "scene.toml:3");
  EXPECT_EQ(place_of(scene, "spheres.1.radius"), "scene.toml:6");
  EXPECT_EQ(place_of(scene, "spheres.1.friction"), "--set spheres.1.friction=0.5");
  EXPECT_EQ(place_of(scene, "spheres.1.velocity"), "scene.toml:5") << "of its section";
  EXPECT_EQ(place_of(scene, "gravity.acceleration"), "scene.toml") << "of neither";
  EXPECT_EQ(place_of(Scene{}, "gravity"), "scene");
  remove_item(scene, "spheres", 0);
  EXPECT_EQ(place_of(scene, "spheres.0.radius"), "scene.toml:6");
  EXPECT_EQ(place_of(scene, "spheres.1.radius"), "scene.toml");
  EXPECT_EQ(place_of(scene, "pins.0.at"), "scene.toml:9");
  remove_section(scene, "spheres");
  EXPECT_EQ(place_of(scene, "spheres.0.radius"), "scene.toml");
}

// 11 particles on 1 m: a = 0.1 m. The point (0.25, 0) lies 0.05 m from its nearest particles.
TEST(Checks, APinMustHoldAParticle) {
  const std::string cloth = "[cloth]\nresolution = 11\n[[pins]]\nat = [0.25, 0.0]\nradius = ";
  expect_refused(cloth + "0.0499\n",
                 {"scene.toml:5: pins.0.radius is 0.0499 m at [0.25, 0]", "0.05 m away", "raise"});
  EXPECT_EQ(refusal(cloth + "0.05\n"), "accepted");
  EXPECT_EQ(refusal("[cloth]\n[[pins]]\nat=[1,1]\nradius=0\n[[pins]]\nat=[0,0]\nradius=0\n"), "accepted");
}

// Height 0.72 m at a = 0.1 m is 8 rows, whose real height is 0.7 m: at = [0, 1] is a particle all the same.
TEST(Checks, PinsCountFromTheRealHeight) {
  EXPECT_EQ(refusal("[cloth]\nresolution=11\nheight=0.72\n[[pins]]\nat=[0,1]\nradius=1e-9\n"), "accepted");
}

TEST(Checks, NearestParticleIsTheNearestOfAll) {
  ClothSection cloth;
  cloth.width_m = 1.3;
  cloth.height_m = 0.9;
  cloth.resolution = 14;  // a = 0.1
  const double a = 1.3 / 13.0;
  for (const glm::dvec2 at : {glm::dvec2(0.0, 0.0), {0.33, 0.71}, {1.0, 1.0}, {0.5, 0.049}}) {
    double nearest_m = 1e9;
    for (int j = 0; j < 10; ++j)
      for (int i = 0; i < 14; ++i)
        nearest_m = std::min(nearest_m, std::hypot(i * a - at.x * 1.3, j * a - at.y * 9.0 * a));
    EXPECT_NEAR(nearest_particle_m(cloth, at), nearest_m, 1e-12);
  }
}

TEST(Checks, RowsAlongTheHeightAreLimitedToo) {
  expect_refused("[cloth]\nheight = 0.001\n",
                 {"scene.toml:2: cloth.height is 0.001", "1 rows", "2 to 4096", "raise"});
  expect_refused("[cloth]\nheight = 100\n", {"6301 rows", "lower"});
  expect_refused("[cloth]\nwidth=10\nresolution = 2\n", {"scene.toml:3"});
  // 2 × 4096 and 4096 × 2, the narrowest of all.
  EXPECT_EQ(refusal("[cloth]\nresolution=2\nwidth=0.1\nheight=409.5\n"), "accepted");
  EXPECT_EQ(refusal("[cloth]\nresolution=4096\nwidth=409.5\nheight=0.1\n"), "accepted");
}

TEST(Checks, SpheresAreLimited) {
  std::string text = "[cloth]\ncenter = [0, 100, 0]\n";
  for (std::uint32_t k = 0; k < shared::kMaxSpheres; ++k) text += "[[spheres]]\ncenter=[0,0,0]\nradius=1\n";
  EXPECT_EQ(refusal(text), "accepted");
  expect_refused(text + "[[spheres]]\ncenter=[0,0,0]\nradius=1\n",
                 {"scene.toml:195", "65 spheres", "at most 64"});
}

TEST(Checks, WarnsOfAStartBelowTheFloor) {
  const LoadedScene loaded = read("[cloth]\ncenter=[0, 0.3, 0]\n[floor]\nheight = 0.1\n");
  ASSERT_EQ(loaded.warnings.size(), 1u);  // the lower edge is at 0.3 − 0.5 = −0.2, 0.3 m below 0.1
  EXPECT_EQ(loaded.warnings[0],
            "scene.toml:4: the cloth starts up to 0.3 m below the floor; raise cloth.center");
  EXPECT_TRUE(read("[cloth]\ncenter=[0, 0.6, 0]\n[floor]\nheight = 0.1\n").warnings.empty());
}

TEST(Checks, WarnsOfAStartInsideASphere) {
  const std::string scene =
      "[cloth]\norientation='horizontal'\nresolution=11\n[[spheres]]\nradius=0.5\ncenter=";
  const LoadedScene loaded = read(scene + "[0, -0.4, 0]\n");
  ASSERT_EQ(loaded.warnings.size(), 1u);  // the middle particle is 0.4 m from the centre
  EXPECT_TRUE(contains(loaded.warnings[0], "scene.toml:4") &&
              contains(loaded.warnings[0], "0.1 m inside spheres.0"))
      << loaded.warnings[0];
  EXPECT_TRUE(read(scene + "[0, -0.51, 0]\n").warnings.empty());
}

// 16 rows over 1 m: a cell is 67 mm.
TEST(Checks, WarnsOfAFirstKeyFarAway) {
  const std::string scene = "[cloth]\nresolution = 16\n[[pins]]\nat = [0, 0]\nkeys = [{ time = ";
  const LoadedScene loaded = read(scene + "0, offset = [0, 3, 4] }]\n");
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(contains(loaded.warnings[0], "scene.toml:5: pins.0.keys begins 5 m") &&
              contains(loaded.warnings[0], "75 cells"))
      << loaded.warnings[0];
  EXPECT_TRUE(read(scene + "0, offset = [0, 0.05, 0] }]\n").warnings.empty());
}

// At 1000 m a float's last bit is 2⁻¹⁴ m = 61 µm, at 500 m half of that; a thousandth of a cell of 1 m/19 is
// 53 µm. A double's is a billionth.
TEST(Checks, WarnsWhereAFloatStrainsTheCloth) {
  const std::string scene = "[cloth]\nresolution = 20\ncenter = [";
  const LoadedScene loaded = read(scene + "1000, 0, 0]\n");
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_TRUE(contains(loaded.warnings[0], "scene.toml:3: the cloth comes up to 1000.7") &&
              contains(loaded.warnings[0], "6.1") && contains(loaded.warnings[0], "f64"))
      << loaded.warnings[0];
  EXPECT_TRUE(read(scene + "500, 0, 0]\n").warnings.empty());
  EXPECT_TRUE(read(scene + "1000, 0, 0]\n[solver]\nprecision = \"f64\"\n").warnings.empty());
}

// The lowest particle of a horizontal cloth with imperfection d is d·min(sin·sin) below the middle; half the
// thickness comes on top.
TEST(Checks, DepthCountsImperfectionAndThickness) {
  const std::string scene =
      "[cloth]\norientation='horizontal'\nresolution=9\nimperfection=0.1\n[floor]\n[self_collision]"
      "\nthickness=0.02\n";
  double lowest = 0.0;
  for (int j = 0; j < 9; ++j)
    for (int i = 0; i < 9; ++i)
      lowest = std::min(lowest, 0.1 * std::sin(3.0 * std::numbers::pi * i / 8.0 + 0.4) *
                                    std::sin(2.0 * std::numbers::pi * j / 8.0 + 0.9));
  const auto warnings = read(scene).warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(contains(warnings[0], fmt::format("up to {:g} m below", 0.01 - lowest))) << warnings[0];
}

TEST(Checks, WarnsOfWindThroughNothing) {
  EXPECT_EQ(read("[cloth]\n[air]\ndrag=0\n[wind]\nvelocity=[0,0,3]\n").warnings.size(), 1u);
}

}  // namespace
}  // namespace weft
