// The Model against the closed forms of docs/physics.md "Grid" and "Material".
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "model/springs.h"

namespace weft {
namespace {

Scene sized(double width_m, double height_m, std::uint32_t resolution) {
  Scene scene;
  scene.cloth.width_m = width_m;
  scene.cloth.height_m = height_m;
  scene.cloth.resolution = resolution;
  return scene;
}

TEST(Grid, CellsAreSquareAndTheHeightRoundsHalvesAwayFromZero) {
  const Model tall = build_model(sized(1.0, 2.0, 5));
  EXPECT_EQ(tall.grid.nx, 5u);
  EXPECT_EQ(tall.grid.ny, 9u);
  EXPECT_DOUBLE_EQ(tall.grid.height_m(), 2.0);
  EXPECT_EQ(build_model(sized(1.0, 0.625, 5)).grid.ny, 4u);  // 2.5 cells round to 3
  EXPECT_EQ(build_model(sized(1.0, 0.62, 5)).grid.ny, 3u);
  EXPECT_EQ(build_model(sized(1.0, 1.0, 64)).grid.ny, 64u);
}

TEST(Grid, RefusesWhatIsNoGrid) {
  for (const Scene& scene : {sized(1, 1, 1), sized(1, 0.1, 3), sized(1e-3, 1e6, 4096)}) {
    try {
      build_model(scene);
      FAIL() << "accepted";
    } catch (const Error& refused) {
      EXPECT_EQ(refused.code(), Exit::usage);
      EXPECT_NE(std::string(refused.what()).find("cloth."), std::string::npos) << refused.what();
    }
  }
}

// The half and quarter cells of edges and corners add up to the cloth: Σm = ρ·w·h exactly.
TEST(Masses, AddUpToDensityTimesArea) {
  for (const auto& [width, height, n] :
       {std::tuple{1.0, 1.0, 33u}, {0.7, 1.4, 8u}, {2.0, 0.5, 41u}, {1.0, 1.0, 2u}}) {
    const Model model = build_model(sized(width, height, n));
    double sum_kg = 0.0;
    for (std::uint32_t p = 0; p < model.grid.count(); ++p) sum_kg += 1.0 / model.inverse_mass(p);
    const double expected_kg = 0.2 * model.grid.width_m() * model.grid.height_m();
    EXPECT_NEAR(sum_kg, expected_kg, 1e-12 * expected_kg);
  }
}

TEST(Springs, CountsFollowTheGrid) {
  Scene scene = sized(1.0, 0.5, 9);  // 9 × 5
  const std::uint64_t nx = 9, ny = 5;
  const std::uint64_t structural = (nx - 1) * ny + nx * (ny - 1), shear = 2 * (nx - 1) * (ny - 1);
  const std::uint64_t flex = (nx - 2) * ny + nx * (ny - 2);
  EXPECT_EQ(build_model(scene).spring_count, structural + shear + flex);
  scene.material.flex = 0.0;
  EXPECT_EQ(build_model(scene).spring_count, structural + shear);
  scene.material.shear_n_m = 0.0;
  EXPECT_EQ(build_model(scene).spring_count, structural);
  scene.material.flex = 1.0;  // nothing is left for the structural springs
  EXPECT_EQ(build_model(scene).spring_count, flex);
}

TEST(Springs, BetweenTwoPinnedParticlesAreOmitted) {
  Scene scene = sized(1.0, 1.0, 5);
  const std::uint64_t all = build_model(scene).spring_count;
  scene.pins = {{{0.0, 0.0}, 0.36}};  // the corner, both its neighbours and their diagonal (0.25·√2)
  // Held: (0,0) (1,0) (0,1) (1,1): four structural and two shear springs join two of them.
  EXPECT_EQ(build_model(scene).spring_count, all - 6);
}

TEST(Springs, ConstantsDoNotDependOnTheResolution) {
  Scene scene;
  scene.material = {.preset = "", .density_kg_m2 = 0.3, .membrane_n_m = 800, .shear_n_m = {}, .flex = 0.2};
  for (const std::uint32_t n : {5u, 65u}) {
    scene.cloth.resolution = n;
    const Model model = build_model(scene);
    const double a = 1.0 / (n - 1);
    EXPECT_NEAR(model.springs[kStructuralI].stiffness_n_m, 0.8 * 0.75 * 800, 1e-9);
    EXPECT_NEAR(model.springs[kShearUp].stiffness_n_m, 300.0, 1e-9);  // 3Y/8 by default
    EXPECT_NEAR(model.springs[kFlexJ].stiffness_n_m, 0.2 * 3 * 800 / 16, 1e-9);
    EXPECT_NEAR(model.springs[kShearDown].rest_m, a * std::numbers::sqrt2, 1e-15);
    EXPECT_NEAR(model.springs[kFlexI].rest_m, 2 * a, 1e-15);
    EXPECT_NEAR(model.interior_mass_kg, 0.3 * a * a, 1e-15);
  }
}

TEST(Springs, DampingIsCappedByTheRatio) {
  Scene scene;
  const double k = 562.5;      // structural, by default
  scene.cloth.resolution = 3;  // coarse: β·k is the smaller
  EXPECT_NEAR(build_model(scene).springs[kStructuralI].damping_n_s_m, 1e-4 * k, 1e-15);
  scene.cloth.resolution = 513;
  const Model fine = build_model(scene);
  EXPECT_NEAR(fine.springs[kStructuralI].damping_n_s_m, 0.2 * std::sqrt(k * fine.interior_mass_kg / 2),
              1e-15);
  EXPECT_LT(fine.springs[kStructuralI].damping_n_s_m, 1e-4 * k);
}

TEST(Pins, HoldWhatIsWithinTheRadiusOnTheFlatCloth) {
  Scene scene = sized(1.0, 0.5, 21);  // a = 0.05
  scene.pins = {{{0.5, 0.5}, 0.1}};   // exactly two cells: the four outermost count too
  const Model model = build_model(scene);
  std::uint32_t held = 0;
  for (std::uint32_t j = 0; j < model.grid.ny; ++j) {
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      const int di = static_cast<int>(i) - 10, dj = static_cast<int>(j) - 5;
      const bool inside = di * di + dj * dj <= 4;
      EXPECT_EQ(model.relative_inverse_mass[model.grid.index(i, j)] == 0.0, inside) << i << ", " << j;
      held += inside;
    }
  }
  EXPECT_EQ(held, 13u);
}

TEST(Pins, OnTheEdgeHoldTheWholeRow) {
  Scene scene = sized(1.0, 1.0, 9);
  scene.pins = {{{0.5, 0.0}, 0.5}};
  const Model model = build_model(scene);
  for (std::uint32_t i = 0; i < 9; ++i) EXPECT_EQ(model.relative_inverse_mass[i], 0.0);
  EXPECT_EQ(model.inverse_mass(0), 0.0);
}

TEST(Pins, ThatHoldNothingAreRefused) {
  Scene scene = sized(1.0, 1.0, 5);
  scene.pins = {{{0.0, 0.0}, 0.05}, {{0.125 / 1.0, 0.125}, 0.05}};
  try {
    build_model(scene);
    FAIL() << "accepted";
  } catch (const Error& refused) {
    EXPECT_EQ(refused.code(), Exit::usage);
    EXPECT_NE(std::string(refused.what()).find("pins[1]"), std::string::npos) << refused.what();
  }
}

TEST(Start, LiesFlatAboutItsCenter) {
  Scene scene = sized(1.0, 0.5, 5);
  scene.cloth.center_m = {1.0, 2.0, 3.0};
  const State vertical = start_state(build_model(scene));
  EXPECT_EQ(vertical.position.front(), glm::dvec3(0.5, 2.25, 3.0));
  EXPECT_EQ(vertical.position.back(), glm::dvec3(1.5, 1.75, 3.0));
  scene.cloth.orientation = Orientation::horizontal;
  const State horizontal = start_state(build_model(scene));
  EXPECT_EQ(horizontal.position.front(), glm::dvec3(0.5, 2.0, 2.75));
  EXPECT_EQ(horizontal.position.back(), glm::dvec3(1.5, 2.0, 3.25));
  for (const glm::dvec3& v : horizontal.velocity) EXPECT_EQ(v, glm::dvec3(0.0));
}

TEST(Start, ImperfectionIsTheStatedWaveAlongTheNormal) {
  Scene scene = sized(1.0, 1.0, 9);
  scene.cloth.imperfection_m = 0.01;
  const Model model = build_model(scene);
  const State state = start_state(model);
  const double pi = std::numbers::pi;
  const double expected_m = 0.01 * std::sin(3 * pi * 5 / 8 + 0.4) * std::sin(2 * pi * 3 / 8 + 0.9);
  EXPECT_NEAR(state.position[model.grid.index(5, 3)].z, expected_m, 1e-16);
  EXPECT_EQ(model.springs[kStructuralI].rest_m, 0.125);  // rest lengths stay those of the flat cloth
}

TEST(Wind, GustsAboutItsVelocity) {
  Scene scene;
  EXPECT_EQ(wind_at(scene, 1.0), glm::dvec3(0.0));
  scene.wind = WindSection{{0.0, 0.0, 3.0}, 0.5, 2.0};
  EXPECT_EQ(wind_at(scene, 0.0).z, 3.0);
  EXPECT_NEAR(wind_at(scene, 0.5).z, 4.5, 1e-12);
  EXPECT_NEAR(wind_at(scene, 1.5).z, 1.5, 1e-12);
  scene.wind->period_s = 0.0;  // no gust
  EXPECT_EQ(wind_at(scene, 0.5).z, 3.0);
}

TEST(Sphere, MovesUniformly) {
  const SphereSection sphere{{1, 2, 3}, 0.5, {-1, 0, 2}, 0.0};
  EXPECT_EQ(sphere_center_at(sphere, 0.5), glm::dvec3(0.5, 2.0, 4.0));
}

}  // namespace
}  // namespace weft
