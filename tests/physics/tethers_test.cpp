// Tethers: XPBD's cloth is no farther from its pins than it is long, and what is slack is left alone.
#include "model/tethers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "plan/plan.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

Scene heavy_scene(bool tethered) {
  Scene scene = bare_scene(17, 17, 1.0 / 16);
  scene.gravity = GravitySection{};
  scene.material.membrane_n_m = 20.0;  // so soft that it hangs far down
  scene.pins = {{{0.0, 0.0}, 0.05}, {{1.0, 0.0}, 0.05}};
  scene.solver.name = "xpbd";
  if (tethered) scene.tethers = TethersSection{0.02};
  return scene;
}

/// The largest of distance over reach.
double tautest(const Model& model, const State& state) {
  double most = 0.0;
  for (std::uint32_t p = 0; p < model.tethers.size(); ++p)
    if (const Tether& t = model.tethers[p]; t.reach_m > 0.0)
      most = std::max(most, glm::distance(state.position[p], state.position[t.anchor]) / t.reach_m);
  return most;
}

// Against every pair: the nearest pinned particle, by brute force.
TEST(Tethers, GoToTheNearestPin) {
  Scene scene = heavy_scene(true);
  scene.cloth.height_m = 0.7;
  scene.pins = {{{0.0, 0.0}, 0.05}, {{0.8, 0.3}, 0.1}, {{0.4, 1.0}, 0.05}};
  const Model model = build_model(scene);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
    double nearest_m = 1e9;
    for (std::uint32_t q = 0; q < model.grid.count(); ++q) {
      if (model.relative_inverse_mass[q] != 0.0) continue;
      const double di = double(p % 17) - double(q % 17), dj = double(p / 17) - double(q / 17);
      nearest_m = std::min(nearest_m, model.grid.spacing_m * std::hypot(di, dj));
    }
    if (nearest_m == 0.0) {
      EXPECT_LT(model.tethers[p].reach_m, 0.0);
      continue;
    }
    EXPECT_NEAR(model.tethers[p].reach_m, 1.02 * nearest_m, 1e-12) << p;
    EXPECT_EQ(model.relative_inverse_mass[model.tethers[p].anchor], 0.0);
  }
}

// Contact comes after the tethers and there is none here: at the frame's end no tether is longer than its
// reach.
TEST(Tethers, HoldToRoundOff) {
  const Model model = build_model(heavy_scene(true));
  const State end = run_frames(model, start_state(model), "xpbd", "f64", 60, 1.0 / 60, 20);
  EXPECT_LE(tautest(model, end), 1.0 + 1e-12);
  EXPECT_GT(tautest(model, end), 1.0 - 1e-9) << "or nothing is taut";
  Model without = build_model(heavy_scene(false));
  const State loose = run_frames(without, start_state(without), "xpbd", "f64", 60, 1.0 / 60, 20);
  EXPECT_GT(tautest(model, loose), 1.2) << "or there is nothing to hold";
}

// They pull only: a cloth that hangs within its length has the bits it has without them.
TEST(Tethers, WhatIsSlackIsLeftAlone) {
  Scene scene = heavy_scene(false), tethered = heavy_scene(true);
  scene.material.membrane_n_m = tethered.material.membrane_n_m = 1e5;
  tethered.tethers->slack = 1.0;
  const auto end = [](const Scene& s) {
    const Model model = build_model(s);
    return state_hash(run_frames(model, start_state(model), "xpbd", "f32", 20, 1.0 / 60, 20));
  };
  EXPECT_EQ(end(scene), end(tethered));
}

TEST(Tethers, AreXpbdsAndNeedAPin) {
  Scene scene = heavy_scene(true);
  const Model model = build_model(scene);
  EXPECT_THROW(compile_plan(model, find_solver("leapfrog")), Error);
  const Plan plan = compile_plan(model, find_solver("xpbd"));
  const Plan without = compile_plan(build_model(heavy_scene(false)), find_solver("xpbd"));
  EXPECT_EQ(plan.steps.size(), without.steps.size() + 1);
  EXPECT_EQ(plan.bytes(), without.bytes() + 8 * model.grid.count());
  for (PinSection& pin : scene.pins) pin.release_s = 1.0;
  EXPECT_THROW(build_model(scene), Error) << "every pin lets go";
}

}  // namespace
}  // namespace weft
