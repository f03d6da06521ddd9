// Measures on states whose energy, stretch, momentum and penetration are known by hand.
#include "model/measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft {
namespace {

Scene square(std::uint32_t resolution) {
  Scene scene;
  scene.cloth.resolution = resolution;
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  return scene;
}

// A cloth stretched by ε along its width: ½·k_s·ε² per area, k_s = 3Y/4; the boundary weights make it exact.
TEST(Energy, OfAUniformStretch) {
  const Model model = build_model(square(9));
  State state = start_state(model);
  for (glm::dvec3& x : state.position) x.x *= 1.01;
  EXPECT_NEAR(energy(model, state).elastic_j, 0.5 * 750.0 * 1e-4, 1e-12);
  EXPECT_NEAR(stretch(model, state).maximum, 0.01, 1e-12);
  EXPECT_NEAR(stretch(model, state).p99, 0.01, 1e-12);
}

// z = ½c·x²: the second difference is c·a² at every triple along i, (n − 2) triples on each of n lines.
TEST(Energy, OfAParabola) {
  Scene scene = square(11);
  scene.material.bend_n_m = 0.02;
  const Model model = build_model(scene);
  State state = start_state(model);
  const double c = 0.3, a = 0.1;
  for (glm::dvec3& x : state.position) x.z = 0.5 * c * x.x * x.x;
  const double lines = 10.0;  // nine whole ones, two halves
  EXPECT_NEAR(energy(model, state).bending_j, 0.5 * (0.02 / (a * a)) * lines * 9 * std::pow(c * a * a, 2),
              1e-15);
}

TEST(Energy, OfMotionAndHeight) {
  Scene scene = square(5);
  scene.gravity = GravitySection{};
  scene.cloth.center_m = {0, 3, 0};
  const Model model = build_model(scene);
  State state = start_state(model);
  for (glm::dvec3& v : state.velocity) v = {1, 2, 2};
  EXPECT_NEAR(energy(model, state).kinetic_j, 0.5 * 0.2 * 9.0, 1e-14);
  EXPECT_NEAR(energy(model, state).gravity_j, 0.2 * 9.81 * 3.0, 1e-14);
  EXPECT_NEAR(energy(model, state).total(), 0.9 + 0.2 * 9.81 * 3.0, 1e-13);
}

TEST(Stretch, P99LeavesOutTheTail) {
  const Model model = build_model(square(21));  // 840 structural springs: nine lie above the 99th percentile
  State state = start_state(model);
  state.position[0] += glm::dvec3(-0.05, 0.0, 0.0);
  EXPECT_NEAR(stretch(model, state).maximum, 1.0, 1e-9);
  EXPECT_NEAR(stretch(model, state).p99, 0.0, 1e-9);
  state.position[0].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(stretch(model, state).maximum));
}

TEST(Momentum, OfARotatingSquare) {
  const Model model = build_model(square(3));
  State state = start_state(model);
  for (std::size_t p = 0; p < state.position.size(); ++p)
    state.velocity[p] = glm::dvec3(-state.position[p].y, state.position[p].x, 0.0) + glm::dvec3(0, 0, 2);
  EXPECT_NEAR(linear_momentum(model, state).z, 0.4, 1e-15);
  // Σ m r²: edges' middles m0/2 at ½, corners m0/4 at √½; m0 = 0.05 kg.
  EXPECT_NEAR(angular_momentum(model, state).z, 4 * 0.025 * 0.25 + 4 * 0.0125 * 0.5, 1e-15);
}

TEST(Distance, RmsAndMaximum) {
  const Model model = build_model(square(2));
  const State a = start_state(model);
  State b = a;
  b.position[1].y += 3.0;
  b.position[2].z += 4.0;
  EXPECT_DOUBLE_EQ(rms_distance(a, b), 2.5);
  EXPECT_DOUBLE_EQ(max_distance(a, b), 4.0);
  b.position[3].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(max_distance(a, b)));
}

TEST(Penetration, CountsThicknessAndTheSpheresMotion) {
  Scene scene = square(3);
  scene.self_collision = SelfCollisionSection{0.02};
  scene.floor = FloorSection{-1.0, 0.0};
  const Model bare = build_model(scene);
  EXPECT_EQ(deepest_penetration(bare, start_state(bare)), 0.0);
  scene.floor->height_m = -0.495;  // lowest row at −0.5, surface at −0.485
  const Model above = build_model(scene);
  EXPECT_NEAR(deepest_penetration(above, start_state(above)), 0.015, 1e-12);
  scene.floor.reset();
  scene.spheres = {{{0, 0, 10}, 0.2, {0, 0, -1}, 0.0}};
  const Model sphere = build_model(scene);
  State state = start_state(sphere);
  EXPECT_EQ(deepest_penetration(sphere, state), 0.0);
  state.time_s = 9.9;  // the centre has come to z = 0.1
  EXPECT_NEAR(deepest_penetration(sphere, state), 0.21 - 0.1, 1e-9);
}

TEST(Finite, NamesTheFirstBadParticle) {
  const Model model = build_model(square(4));
  State state = start_state(model);
  std::uint32_t bad = 99;
  EXPECT_TRUE(all_finite(state, &bad));
  state.velocity[7].y = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(all_finite(state, &bad));
  EXPECT_EQ(bad, 7u);
}

// FNV-1a of 24 zero bytes: the offset basis times the prime, 24 times.
TEST(Hash, IsFnvOfTheFloats) {
  State state;
  state.position = {glm::dvec3(0.0, -0.0, 1e-60)};  // −0 counts as +0; 1e-60 rounds to it
  state.velocity = {glm::dvec3(-1e-60, 0.0, 0.0)};
  std::uint64_t expected = 0xcbf29ce484222325ull;
  for (int byte = 0; byte < 24; ++byte) expected *= 0x100000001b3ull;
  EXPECT_EQ(state_hash(state), expected);
  state.velocity[0].z = 1e-7;
  EXPECT_NE(state_hash(state), expected);
}

}  // namespace
}  // namespace weft
