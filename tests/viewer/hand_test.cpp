// Picking the cloth under the pointer, and the hand that pulls it.
#include "viewer/hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <random>

#include "viewer/pick.h"

namespace weft {
namespace {

Scene sheet(std::uint32_t resolution) {
  Scene scene;
  scene.cloth.resolution = resolution;
  return scene;
}

// The ray and the matrix that draws are written apart: any point on the ray must be drawn where it came from.
TEST(Pick, RaysAgreeWithThePicture) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    Camera camera;
    camera.target_m = {unit(random), unit(random), unit(random)};
    camera.yaw_rad = 6.0 * unit(random);
    camera.pitch_rad = 2.4 * unit(random) - 1.2;
    camera.distance_m = 0.5 + 4.0 * unit(random);
    const double aspect = 0.6 + 2.0 * unit(random);
    const glm::dvec2 point{unit(random), unit(random)};
    const Ray ray = camera_ray(camera, aspect, point);
    const glm::dvec3 there = ray.origin + (camera.near_m() + 3.0 * unit(random)) * 1.5 * ray.direction;
    const glm::vec4 drawn = camera.clip(aspect) * glm::vec4(glm::vec3(there), 1.0f);
    EXPECT_NEAR(0.5 + 0.5 * drawn.x / drawn.w, point.x, 2e-4);
    EXPECT_NEAR(0.5 + 0.5 * drawn.y / drawn.w, point.y, 2e-4);
  }
}

TEST(Pick, FindsTheParticleInFrontFromBothSides) {
  const Model model = build_model(sheet(21));
  const State flat = start_state(model);
  const std::uint32_t wanted = model.grid.index(14, 6);
  for (const double side : {1.0, -1.0}) {
    const Ray ray{flat.position[wanted] + glm::dvec3(0.001, 0.001, 2.0 * side), {0.0, 0.0, -side}};
    const auto pick = pick_cloth(model.grid, flat, ray);
    ASSERT_TRUE(pick);
    EXPECT_EQ(pick->particle, wanted);
    EXPECT_NEAR(pick->distance_m, 2.0, 1e-12);
    EXPECT_NEAR(pick->point.z, 0.0, 1e-12);
  }
}

// Between two cloths there is nothing to take; a pin at a particle of the second holds that one.
TEST(Pick, TellsClothsApart) {
  Scene scene = sheet(9);
  scene.cloths = {{.center_m = {3.0, 0.0, 0.0}}};
  const Model model = build_model(scene);
  const State flat = start_state(model);
  const std::uint32_t wanted = model.grid.index(6, model.grid.ny + 2);
  const auto pick =
      pick_cloth(model.grid, flat, {flat.position[wanted] + glm::dvec3(0.01, 0.01, 1.0), {0, 0, -1}});
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->particle, wanted);
  EXPECT_FALSE(pick_cloth(model.grid, flat, {{1.5, 0.0, 1.0}, {0, 0, -1}}));
  scene.pins = {Hand::pin(model.grid, wanted)};
  const Model pinned = build_model(scene);
  EXPECT_EQ(pinned.relative_inverse_mass[wanted], 0.0);
  EXPECT_GT(pinned.relative_inverse_mass[model.grid.index(6, 2)], 0.0);
}

TEST(Pick, TakesTheNearestLayerAndMissesBesideTheCloth) {
  const Model model = build_model(sheet(9));
  State folded = start_state(model);
  for (glm::dvec3& x : folded.position)  // the lower half is folded up in front of the upper one
    if (x.y < 0.0) x = {x.x, -x.y, 0.3};
  const auto pick = pick_cloth(model.grid, folded, {{0.1, 0.3, 5.0}, {0.0, 0.0, -1.0}});
  ASSERT_TRUE(pick);
  EXPECT_NEAR(pick->point.z, 0.3, 1e-12);
  EXPECT_FALSE(pick_cloth(model.grid, folded, {{0.6, 0.3, 5.0}, {0.0, 0.0, -1.0}}));
  EXPECT_FALSE(pick_cloth(model.grid, folded, {{0.1, 0.3, 5.0}, {0.0, 0.0, 1.0}})) << "the cloth is behind";
}

struct Grip {
  Model before, held;
  Hand hand;
};

Grip grip(std::uint32_t resolution) {
  Scene scene = sheet(resolution);
  Grip made{build_model(scene), {}, {}};
  const std::uint32_t particle = made.before.grid.index(resolution / 2, resolution / 2);
  scene.pins.push_back(Hand::pin(made.before.grid, particle));
  made.held = build_model(scene);
  const State state = start_state(made.before);
  made.hand.grab(made.before, made.held, state, {particle, state.position[particle], 1.0});
  return made;
}

TEST(Hand, HoldsAPatchOfTheSameSizeOnEveryGrid) {
  EXPECT_EQ(grip(16).hand.move(0.01).size(), 1u) << "a cell is larger than the patch";
  const std::vector<PlacedParticle> fine = grip(256).hand.move(0.01);
  const double expected = M_PI * Hand::kPatch_m * Hand::kPatch_m * 255.0 * 255.0;
  EXPECT_NEAR(static_cast<double>(fine.size()), expected, 0.1 * expected);
}

TEST(Hand, MovesNoFasterThanItsSpeedAndArrives) {
  Grip made = grip(32);
  const glm::dvec3 start = made.hand.grip(), target = start + glm::dvec3(0.0, 0.0, 0.5);
  made.hand.pull_to(target);
  const auto moved = made.hand.move(1.0 / 60.0);
  EXPECT_NEAR(glm::length(made.hand.grip() - start), Hand::kSpeedMost_m_s / 60.0, 1e-12);
  EXPECT_NEAR(moved.front().velocity_m_s.z, Hand::kSpeedMost_m_s, 1e-5);
  for (int k = 0; k < 10; ++k) made.hand.move(1.0 / 60.0);
  EXPECT_LT(glm::length(made.hand.grip() - target), 1e-12);
  EXPECT_EQ(made.hand.move(1.0 / 60.0).front().velocity_m_s, glm::vec3(0.0f)) << "it rests where it arrived";
}

// A frame is cut so that the hand moves at most a quarter of a cell in a piece: 4 m/s for 1/60 s is 66.7 mm,
// and a quarter of a cell of 1/63 m is 4.0 mm: 17 pieces.
TEST(Hand, FastMovesAreCutIntoPieces) {
  Grip made = grip(64);
  EXPECT_EQ(made.hand.pieces(made.held.grid, 1.0 / 60.0, 100), 1u);
  made.hand.pull_to(made.hand.grip() + glm::dvec3(1.0, 0.0, 0.0));
  EXPECT_EQ(made.hand.pieces(made.held.grid, 1.0 / 60.0, 100), 17u);
  EXPECT_EQ(made.hand.pieces(made.held.grid, 1.0 / 60.0, 5), 5u) << "never more than there are substeps";
}

}  // namespace
}  // namespace weft
