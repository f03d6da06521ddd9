// The static equilibrium against closed forms, and what has none.
#include "study/equilibrium.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "model/measures.h"
#include "study_cloths.h"
#include "support/cloth.h"

namespace weft::study {
namespace {

using testing_support::acceleration;
using testing_support::bare_scene;
using testing_support::pin_where;

TEST(Equilibrium, AHungStripStretchesAsTheClosedFormSays) {
  Scene scene = bare_scene(3, 21, 0.05);
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.bend_n_m = 1e-6;
  scene.gravity.emplace();
  const Model model = pin_where(build_model(scene), [](std::uint32_t, std::uint32_t j) { return j == 0; });
  const Equilibrium rest = find_equilibrium(model, start_state(model), {});
  ASSERT_TRUE(rest.found()) << rest.reason;
  EXPECT_LE(rest.residual_n, kRestForce_n);
  const double k_s = 0.75 * scene.material.membrane_n_m, length_m = 1.0;
  const double expected_m = scene.material.density_kg_m2 * 9.81 * length_m * length_m / (2.0 * k_s);
  const std::uint32_t foot = model.grid.index(1, model.grid.ny - 1);
  const double sunk_m = start_state(model).position[foot].y - rest.position[foot].y;
  EXPECT_NEAR(sunk_m, expected_m, 1e-3 * expected_m);  // bending stiffens it by parts in a million
}

void expect_no_force_left(const Model& model) {
  const Equilibrium rest = find_equilibrium(model, start_state(model), {});
  ASSERT_TRUE(rest.found()) << rest.reason;
  State state = start_state(model);
  state.position = rest.position;
  const std::vector<glm::dvec3> left = acceleration(model, state);
  for (std::size_t p = 0; p < left.size(); ++p) {
    const double mass_kg =
        model.relative_inverse_mass[p] > 0.0 ? model.interior_mass_kg / model.relative_inverse_mass[p] : 0.0;
    EXPECT_LE(mass_kg * glm::length(left[p]), 1.1e-9) << p;
  }
}

TEST(Equilibrium, NoForceIsLeftByTheIndependentForcesOfThePasses) {
  Scene scene = small_scene();
  scene.cloth.orientation = Orientation::horizontal;
  scene.pins.push_back(PinSection{{0.0, 1.0}, 0.05});
  scene.pins.push_back(PinSection{{1.0, 1.0}, 0.05});
  expect_no_force_left(build_model(scene));
  scene.cloths = {{.center_m = {3.0, 0.0, 0.0}}};  // a second one, held by one side
  scene.pins.push_back(PinSection{.at = {0.0, 0.0}, .cloth = 1});
  scene.pins.push_back(PinSection{.at = {0.0, 1.0}, .cloth = 1});
  expect_no_force_left(build_model(scene));
}

TEST(Equilibrium, SaysWhatHasNone) {
  Scene scene = small_scene();
  scene.air = AirSection{0.1};
  scene.wind = WindSection{{1.0, 0.0, 0.0}};
  Model model = build_model(scene);
  EXPECT_EQ(find_equilibrium(model, start_state(model), {}).reason, "it hangs in a wind");
  scene = small_scene();
  scene.pins.clear();
  model = build_model(scene);
  EXPECT_EQ(find_equilibrium(model, start_state(model), {}).reason, "nothing is pinned");
  scene = small_scene();
  scene.floor = FloorSection{.height_m = -0.3};
  model = build_model(scene);
  EXPECT_EQ(find_equilibrium(model, start_state(model), {}).reason, "its rest would touch a collider");
}

}  // namespace
}  // namespace weft::study
