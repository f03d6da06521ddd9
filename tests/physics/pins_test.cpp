// Pins that go with a sphere, and pins that let go: what they hold is where they are, and falls from then on.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "model/step_bound.h"
#include "plan/plan.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

constexpr const char* kEverySolver[] = {
    "leapfrog", "velocity-verlet", "symplectic-euler", "verlet", "euler", "trapezoid", "rk4", "xpbd"};
constexpr double kPinFrame_s = 1.0 / 60;

/// A free metre of nine by nine particles without springs' influence on its fall: held all over or by
/// corners.
Scene hung_scene() {
  Scene scene = bare_scene(9, 9, 0.125);
  scene.material.membrane_n_m = 10.0;
  scene.gravity = GravitySection{};
  return scene;
}

// All is held and let go at once, so that nothing is strained: from then on it is a free fall, g·t²/2.
TEST(Pins, WhatIsLetGoFallsFreely) {
  for (const char* solver : kEverySolver) {
    Scene scene = hung_scene();
    scene.pins = {{.at = {0.5, 0.5}, .radius_m = 1.0, .release_s = 0.1}};
    const Model model = build_model(scene);
    const State start = start_state(model);
    const State held = run_frames(model, start, solver, "f64", 6, kPinFrame_s, 60);
    EXPECT_LE(max_distance(held, start), 1e-15) << solver << ": held until 0.1 s";
    const State end = run_frames(model, start, solver, "f64", 12, kPinFrame_s, 60);
    const double fallen_m = 0.5 * 9.81 * 0.01, step_s = kPinFrame_s / 60;
    for (std::size_t p = 0; p < start.position.size(); ++p)
      ASSERT_NEAR(start.position[p].y - end.position[p].y, fallen_m, 2 * 9.81 * 0.1 * step_s) << solver;
  }
}

// A pin that lets go between two frames, and one that stays: the corner swings, the other is where it was.
TEST(Pins, OnlyThePinThatLetsGoDoes) {
  for (const char* solver : {"leapfrog", "xpbd", "rk4"}) {
    Scene scene = hung_scene();
    scene.pins = {{.at = {0.0, 0.0}, .radius_m = 0.05},
                  {.at = {1.0, 0.0}, .radius_m = 0.05, .release_s = 0.055}};
    const Model model = build_model(scene);
    const State start = start_state(model),
                end = run_frames(model, start, solver, "f64", 12, kPinFrame_s, 60);
    EXPECT_EQ(end.position[0], start.position[0]) << solver;
    EXPECT_LT(end.position[8].y, start.position[8].y - 0.03) << solver;
  }
}

// Two pins on one particle: it is held until the last lets go.
TEST(Pins, TheLongestHoldCounts) {
  Scene scene = hung_scene();
  scene.pins = {{.at = {0.0, 0.0}, .radius_m = 0.05, .release_s = 0.01},
                {.at = {0.0, 0.0}, .radius_m = 0.05}};
  const Model model = build_model(scene);
  EXPECT_TRUE(model.released_inverse_mass.empty());
  EXPECT_EQ(model.inverse_mass_at(0, 1.0), 0.0);
  scene.pins[1].release_s = 0.02;
  const Model both = build_model(scene);
  EXPECT_EQ(both.inverse_mass_at(0, 0.015), 0.0);
  EXPECT_EQ(both.inverse_mass_at(0, 0.02), 4.0) << "a corner has a quarter of the mass";
}

// A pin on a sphere that moves steadily: what it holds is at its start plus the sphere's way, to round-off.
TEST(Pins, AnAttachedPinGoesWithItsSphere) {
  for (const char* solver : kEverySolver) {
    Scene scene = hung_scene();
    scene.spheres = {{.center_m = {0.0, 5.0, 0.0}, .radius_m = 0.1, .velocity_m_s = {0.5, 0.2, -0.3}}};
    scene.pins = {{.at = {0.0, 0.0}, .radius_m = 0.05, .attach = "spheres.0"}};
    const Model model = build_model(scene);
    const State start = start_state(model),
                end = run_frames(model, start, solver, "f64", 12, kPinFrame_s, 60);
    const glm::dvec3 way = 0.2 * scene.spheres[0].velocity_m_s;
    EXPECT_LE(glm::distance(end.position[0], start.position[0] + way), 1e-12) << solver;
    EXPECT_LE(glm::distance(end.velocity[0], scene.spheres[0].velocity_m_s), 1e-9) << solver;
  }
}

// Let go from a sphere, it goes on with the sphere's velocity: momentum of the throw.
TEST(Pins, AThrownClothKeepsTheSphereSpeed) {
  Scene scene = hung_scene();
  scene.gravity.reset();
  scene.spheres = {{.center_m = {0.0, 5.0, 0.0}, .radius_m = 0.1, .velocity_m_s = {1.0, 0.0, 0.0}}};
  scene.pins = {{.at = {0.5, 0.5}, .radius_m = 1.0, .attach = "spheres.0", .release_s = 0.1}};
  const Model model = build_model(scene);
  for (const char* solver : {"leapfrog", "xpbd", "verlet"}) {
    const State end = run_frames(model, start_state(model), solver, "f64", 12, kPinFrame_s, 60);
    for (const glm::dvec3& v : end.velocity) ASSERT_LE(glm::distance(v, {1.0, 0.0, 0.0}), 1e-9) << solver;
  }
}

// What will be free counts in the step bound from the start.
TEST(Pins, TheStepBoundCountsTheWorstCase) {
  Scene free = hung_scene(), released = hung_scene(), held = hung_scene();
  released.pins = {{.at = {0.5, 0.5}, .radius_m = 1.0, .release_s = 1.0}};
  held.pins = {{.at = {0.5, 0.5}, .radius_m = 1.0}};
  EXPECT_EQ(build_model(released).bound.lambda_1_s2, build_model(free).bound.lambda_1_s2);
  EXPECT_EQ(build_model(held).bound.lambda_1_s2, 0.0);
}

TEST(Pins, StillOnesHaveNoPassForIt) {
  Scene scene = hung_scene();
  scene.pins = {{.at = {0.0, 0.0}, .radius_m = 0.05}};
  const auto passes = [](const Scene& s) {
    const Model model = build_model(s);
    std::string names;
    for (const PlanStep& step : compile_plan(model, find_solver("leapfrog")).steps)
      names += std::string(step.pass->name) + " ";
    return names;
  };
  EXPECT_EQ(passes(scene).find("pin_"), std::string::npos);
  scene.pins[0].release_s = 1.0;
  EXPECT_NE(passes(scene).find("pin_release"), std::string::npos);
}

}  // namespace
}  // namespace weft
