// Spheres that move by keys: the contact stays swept, whatever the speed and wherever the motion turns.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "model/measures.h"
#include "scene/reader.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

/// A loose patch at rest in the way of a sphere that comes along z.
Model patch_before(MotionKeys keys) {
  Scene scene = bare_scene(3, 3, 0.01);
  scene.material.membrane_n_m = 1e-3;
  scene.spheres = {{keys.front().place_m, 0.25, {0, 0, 0}, 0.2, std::move(keys)}};
  return build_model(scene);
}

// Written as keys, a steady motion is the steady motion: the same places to round-off, in double.
TEST(KeyedSphere, EqualsTheSteadySphereItDescribes) {
  const Model keyed = patch_before({{0.0, {0, 0, -1}}, {0.02, {0, 0, 1}}});
  Scene steady_scene = keyed.scene;
  steady_scene.spheres = {{{0, 0, -1}, 0.25, {0, 0, 100}, 0.2}};
  const Model steady = build_model(steady_scene);
  const State a = run_frames(keyed, start_state(keyed), "leapfrog", "f64", 7, 0.002, 1);
  const State b = run_frames(steady, start_state(steady), "leapfrog", "f64", 7, 0.002, 1);
  for (std::size_t p = 0; p < a.position.size(); ++p)
    EXPECT_LE(glm::distance(a.position[p], b.position[p]), 1e-11);
}

// At 100 and 1000 m/s the sphere moves by up to four radii a substep. A steady start, a corner in the middle
// of a substep, and a stop: nothing is ever inside, and what it met is never behind it.
TEST(KeyedSphere, SweepsTheClothAlongAtAHundredMetresASecond) {
  for (const double speed_m_s : {10.0, 100.0, 1000.0}) {
    const double cross_s = 2.0 / speed_m_s;
    const Model model = patch_before({{0.3 * cross_s, {0, 0, -1}}, {1.3 * cross_s, {0, 0, 1}}});
    for (const char* solver : {"leapfrog", "xpbd", "rk4", "symplectic-euler"}) {
      const auto simulation = make_cpu_simulation(model, find_solver(solver), "f32");
      for (int step = 0; step < 7; ++step) {
        simulation->advance(0.27 * cross_s, 1);
        const State now = simulation->read();
        EXPECT_LE(deepest_penetration(model, now), 0.01 * 0.25) << solver << " at " << speed_m_s << " m/s";
        const double center_z = sphere_center_at(model.scene.spheres[0], now.time_s).z;
        if (center_z < 0.0) continue;
        for (const glm::dvec3& x : now.position) EXPECT_GT(x.z, center_z) << solver << " at " << speed_m_s;
      }
    }
  }
}

// A sphere that has stopped pushes with no velocity: a cloth resting on it stays, unlike on one still moving.
TEST(KeyedSphere, IsAtRestAfterItsLastKey) {
  const Model model = patch_before({{0.0, {0, 0, -0.5}}, {0.1, {0, 0, -0.2}}});
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f64");
  for (int frame = 0; frame < 12; ++frame) simulation->advance(1.0 / 60, 40);
  const State now = simulation->read();
  for (const glm::dvec3& v : now.velocity) EXPECT_NEAR(v.z, 3.0, 0.2) << "carried off at the sphere's 3 m/s";
  EXPECT_EQ(sphere_center_at(model.scene.spheres[0], now.time_s), glm::dvec3(0, 0, -0.2));
}

TEST(KeyedSphere, TheSampleSceneIsHitAndHolds) {
  const Model model = build_model(load_scene(WEFT_SOURCE_DIR "/tests/scenes/wrecking-ball.toml").scene);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  double farthest_m = 0.0;
  for (int frame = 0; frame < 24; ++frame) {
    simulation->advance(1.0 / 60, simulation->plan().substeps);
    const State now = simulation->read();
    ASSERT_TRUE(all_finite(now, nullptr));
    EXPECT_LE(deepest_penetration(model, now), 0.01 * 0.15) << "frame " << frame;
    for (const glm::dvec3& x : now.position) farthest_m = std::max(farthest_m, x.z);
  }
  EXPECT_GT(farthest_m, 0.5) << "the ball took the cloth along";
}

}  // namespace
}  // namespace weft
