// Static shapes with closed forms: a hanging strip and a bent cantilever.
#include <gtest/gtest.h>

#include "model/measures.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

// Stretch = ρ g L²/(2 k_s), k_s = 3Y/4, exactly: the half-mass end row makes the discrete factor 1.
TEST(Strip, StretchesUnderItsWeight) {
  for (const std::uint32_t rows : {5u, 17u}) {
    Scene scene = bare_scene(3, rows, 0.8 / (rows - 1));
    scene.material.flex = 0.0;
    scene.material.shear_n_m = 0.0;
    scene.gravity = GravitySection{};
    const Model model = pin_where(build_model(scene), [](auto, auto j) { return j == 0; });
    // The slowest mode along the strip: (π/2L)·√(k_s/ρ) = 120 /s.
    const State rest = settle(model, 240.0, 0.5);
    const double length_m = rest.position[1].y - rest.position[model.grid.index(1, rows - 1)].y;
    const double expected_m = 0.2 * 9.81 * 0.8 * 0.8 / (2 * 750.0);
    EXPECT_NEAR(length_m - 0.8, expected_m, 1e-6 * expected_m) << rows;
  }
}

/// Tip drop over tip reach of a cantilever of 24 cells at Γ = ρ g L³/B, at rest.
/// Two pinned rows hold the tangent exactly half a cell before the last of them, so that is where the beam
/// is clamped to second order; L and the reach are measured from there.
double cantilever_drop(double gamma) {
  const std::uint32_t rows = 26;
  const double a = 0.5 / 24.5, length_m = 0.5;
  Scene scene = bare_scene(3, rows, a);
  scene.cloth.orientation = Orientation::horizontal;
  scene.gravity = GravitySection{};
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.membrane_n_m = 2e4;  // stretches by less than 1e-4
  scene.material.bend_n_m = 0.2 * 9.81 * std::pow(length_m, 3) / gamma;
  const Model model = pin_where(build_model(scene), [](auto, auto j) { return j < 2; });
  const double slowest_1_s = 3.516 / (length_m * length_m) * std::sqrt(scene.material.bend_n_m / 0.2);
  const State rest = settle(model, 2 * slowest_1_s, 16 / slowest_1_s);
  const glm::dvec3 tip = rest.position[model.grid.index(1, rows - 1)];
  const double clamp_z = rest.position[model.grid.index(1, 1)].z - 0.5 * a;
  return (rest.position[1].y - tip.y) / (tip.z - clamp_z);
}

// The elastica under its own weight (table of docs/physics.md), from nearly straight to steeply hanging.
TEST(Cantilever, DropsAsTheElastica) {
  for (const auto& [gamma, drop] : {std::pair{1.0, 0.12456}, {5.0, 0.58572}, {20.0, 1.86393}})
    EXPECT_NEAR(cantilever_drop(gamma), drop, 0.005 * drop) << "gamma " << gamma;
}

}  // namespace
}  // namespace weft
