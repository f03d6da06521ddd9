// Divergence: what is found, where, when and why, what is kept, and that nothing sound is ever stopped.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gpu_fixture.h"
#include "model/speed_budget.h"
#include "model/springs.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "plan/buffers.h"
#include "sim/gpu_simulation.h"
#include "sim/scenes.h"

namespace weft::test {
namespace {

class WatchTest : public GpuTest {
 protected:
  /// The model on the device and on the CPU.
  std::vector<std::unique_ptr<Simulation>> both(const Model& model, const char* solver = "leapfrog") {
    std::vector<std::unique_ptr<Simulation>> simulations;
    simulations.push_back(GpuSimulation::create(device(), model, find_solver(solver)));
    simulations.push_back(make_cpu_simulation(model, find_solver(solver), "f32"));
    return simulations;
  }
};

TEST_F(WatchTest, FindsTheParticleThatIsNotANumberAndKeepsTheStateBefore) {
  for (const auto& simulation : both(full_model())) {
    const std::uint32_t n = simulation->plan().substeps;
    for (int f = 0; f < 3; ++f) simulation->advance(1.0 / 60.0, n);
    const State good = simulation->read();
    EXPECT_FALSE(simulation->divergence());
    expect_same(*simulation->last_good(), good, "kept");
    EXPECT_DOUBLE_EQ(simulation->last_good()->time_s, good.time_s);

    State bad = good;
    bad.velocity[77].y = std::numeric_limits<double>::quiet_NaN();
    simulation->write(bad);
    const std::optional<Divergence> found = simulation->divergence();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->frame, 0u);
    EXPECT_EQ(found->particle, 77u);
    EXPECT_TRUE(std::isnan(found->speed_m_s));
    EXPECT_FALSE(simulation->last_good()) << "no sound state since the bad one was written";
    simulation->write(good);
    EXPECT_FALSE(simulation->divergence());
  }
}

// 4 substeps of a frame where the bound asks for more than 60: the first frame is unsound, so that the state
// kept is the one the run began with, however many frames come after it.
TEST_F(WatchTest, KeepsTheLastGoodStateWhateverComesAfterIt) {
  const Model model = full_model();
  for (const auto& simulation : both(model)) {
    const State start = simulation->read();
    for (int f = 0; f < 20; ++f) simulation->advance(1.0 / 60.0, 4);
    simulation->read();
    const std::optional<Divergence> found = simulation->divergence();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->frame, 1u);
    EXPECT_EQ(found->substeps, 4u);
    EXPECT_DOUBLE_EQ(found->time_s, 1.0 / 60.0);
    expect_same(*simulation->last_good(), start, "kept");
    EXPECT_DOUBLE_EQ(simulation->last_good()->time_s, 0.0);
    EXPECT_NE(likely_cause(*found, model, simulation->plan()).find("too few substeps"), std::string::npos);
  }
}

TEST_F(WatchTest, SaysWhenASolverIsUnstableByNature) {
  const Model model = scene_model("1", {{"cloth.resolution=16"}});
  for (const auto& simulation : both(model, "euler")) {
    for (int f = 0; f < 60 && !simulation->divergence(); ++f)
      simulation->advance(1.0 / 60.0, simulation->plan().substeps);
    simulation->read();
    const std::optional<Divergence> found = simulation->divergence();
    ASSERT_TRUE(found);
    EXPECT_NE(likely_cause(*found, model, simulation->plan()).find("euler"), std::string::npos);
    EXPECT_TRUE(all_finite(*simulation->last_good()));
  }
}

// All particles at one speed v: the mean square speed is v², and the allowance of a state at rest is
// kMargin · 1 m/s. Half a per cent on either side of it.
TEST_F(WatchTest, StopsAtTheAllowedEnergyAndNotBelow) {
  const Model model = build_model(parse_scene("[cloth]\nresolution = 33\n", "free.toml").scene);
  const double allowed_m_s = SpeedBudget(model, start_state(model), true).allowed_m_s();
  EXPECT_DOUBLE_EQ(allowed_m_s, SpeedBudget::kMargin);
  HostBuffers<float> buffers;
  const Plan plan = compile_plan(model, find_solver("leapfrog"));
  for (const double share : {0.995, 1.005}) {
    size_buffers(plan, model, buffers);
    State moving = start_state(model);
    for (glm::dvec3& v : moving.velocity) v = {0.6 * share * allowed_m_s, 0.0, 0.8 * share * allowed_m_s};
    load_state(model, moving, buffers);
    for (const PlanStep& step : plan.steps)
      if (watches(*step.pass))
        step.pass->mirror_f32({model, step.constants, KickDrift{}, 0, 0, allowed_m_s}, buffers);
    const auto found = divergence_in(buffers.words_of(BufferId::watch_state));
    EXPECT_EQ(found.has_value(), share > 1.0) << share;
    if (found) {
      EXPECT_NEAR(found->energy_share, 16.0 * share * share, 0.02) << "kMargin² is what is allowed";
    }
  }
}

// A sheet that falls freely for an hour is as sound as on its first frame: g·t = 35 km/s.
TEST(SpeedBudgetTest, GrowsWithWhatGravityWindAndSpheresGive) {
  Scene scene;
  scene.cloth.resolution = 8;
  scene.gravity.emplace();
  const Model model = build_model(scene);
  SpeedBudget budget(model, start_state(model), true);
  for (int minute = 0; minute < 60; ++minute) budget.elapse(scene, 60.0, 1);
  EXPECT_NEAR(budget.allowed_m_s(), SpeedBudget::kMargin * (1.0 + 9.81 * 3600.0), 1e-3);

  // A state's own energy counts whole: ½mv² of every particle is a mean square speed of v².
  State moving = start_state(model);
  for (glm::dvec3& v : moving.velocity) v.x = 300.0;
  EXPECT_NEAR(SpeedBudget(model, moving, true).allowed_m_s(), SpeedBudget::kMargin * 301.0, 1e-9);

  // Sixteen times the stiffness: what is stored is sixteen times as much, which is four times the speed.
  Scene stiff = scene;
  stiff.material.membrane_n_m *= 16.0;
  SpeedBudget adopted(model, moving, true);
  adopted.adopt(model, build_model(stiff));
  EXPECT_NEAR(adopted.allowed_m_s(), 4.0 * SpeedBudget::kMargin * 301.0, 1e-9);

  // In float, a substep rounds a position at 1000 m by up to 3e-5 m, which strains springs.
  Scene far = scene;
  far.gravity.reset();
  far.cloth.center_m.x = 1000.0;
  const Model distant = build_model(far);
  SpeedBudget rounded(distant, start_state(distant), false);
  rounded.elapse(far, 1e-3, 1);
  double stiffness_n_m = 0.0;
  for_each_spring(distant, [&](const SpringKind& kind, std::uint32_t, std::uint32_t, double weight) {
    stiffness_n_m += weight * kind.stiffness_n_m;
  });
  const double mass_kg = free_mass_ratio(distant) * distant.interior_mass_kg;
  const double strained_m_s = 2.0 * std::sqrt(stiffness_n_m / mass_kg) * 1000.0 * 0x1p-24;
  EXPECT_NEAR(rounded.allowed_m_s() / SpeedBudget::kMargin - 1.0, strained_m_s, 1e-3 * strained_m_s);

  // A sphere at s: 2s when it is first seen; it strains springs where they are held.
  scene.gravity.reset();
  scene.spheres.push_back({.center_m = {0.0, -9.0, 0.0}, .radius_m = 0.1, .velocity_m_s = {0.0, 3.0, 4.0}});
  const Model pushed = build_model(scene);
  SpeedBudget with_sphere(pushed, start_state(pushed), true);
  with_sphere.elapse(scene, 0.0, 1);
  EXPECT_NEAR(with_sphere.allowed_m_s(), SpeedBudget::kMargin * (1.0 + 2.0 * 5.0), 1e-9);
}

}  // namespace
}  // namespace weft::test
