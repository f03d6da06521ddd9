// Tearing: what is whole keeps its bits, forces are the slope of the energy that is left, breaking takes
// energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "core/error.h"
#include "model/links.h"
#include "model/measures.h"
#include "plan/buffers.h"
#include "plan/plan.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

Scene torn_scene(double strain) {
  Scene scene = bare_scene(9, 8, 0.05);
  scene.material.bend_n_m = 0.01;
  scene.material.damping_s = 0.0;
  scene.tearing = TearingSection{strain};
  return scene;
}

/// Each link is broken with probability one half.
std::vector<std::uint32_t> random_links(const Grid& grid, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> links(grid.count());
  for (std::uint32_t& word : links) word = random() & 15u;
  return links;
}

/// Acceleration [m/s²] by the pass: one second's kick without drift, in double.
std::vector<glm::dvec3> torn_acceleration(const Model& model, const State& state) {
  HostBuffers<double> buffers;
  buffers.words_of(BufferId::broken_links).resize(model.grid.count());
  load_state(model, state, buffers);
  const Constants constants = integrate_torn.constants(model);
  const KickDrift row{.kick_s = 1.0};
  integrate_torn.mirror_f64({model, constants, row, 0}, buffers);
  std::vector<glm::dvec3> result;
  for (std::size_t p = 0; p < state.position.size(); ++p)
    result.push_back(glm::dvec3(buffers[BufferId::velocity_next][p]) - state.velocity[p]);
  return result;
}

// m·a = −∂E/∂x, by central differences of the measured energy: springs and bending leave together.
TEST(Tearing, ForcesAreTheSlopeOfWhatIsLeft) {
  const Model model = build_model(torn_scene(0.3));
  State state = start_state(model);
  shake(state, 0.01, 0.0, 5);
  state.broken_links = random_links(model.grid, 11);
  const std::vector<glm::dvec3> acceleration = torn_acceleration(model, state);
  constexpr double kStep_m = 1e-6;
  for (std::uint32_t p = 0; p < model.grid.count(); ++p)
    for (int axis = 0; axis < 3; ++axis) {
      State to = state, from = state;
      to.position[p][axis] += kStep_m;
      from.position[p][axis] -= kStep_m;
      const auto stored = [&](const State& s) {
        return energy(model, s).elastic_j + energy(model, s).bending_j;
      };
      const double slope_n = (stored(to) - stored(from)) / (2 * kStep_m);
      ASSERT_NEAR(acceleration[p][axis] / model.inverse_mass(p), -slope_n, 1e-5) << p << "." << axis;
    }
}

TEST(Tearing, BreakingNeverAddsEnergy) {
  const Model model = build_model(torn_scene(0.05));
  for (unsigned seed = 0; seed < 20; ++seed) {
    State state = start_state(model);
    shake(state, 0.01, 0.0, seed);
    HostBuffers<double> buffers;
    buffers.words_of(BufferId::broken_links).resize(model.grid.count());
    state.broken_links = random_links(model.grid, 100 + seed);
    for (std::uint32_t& word : state.broken_links) word &= 5u;
    load_state(model, state, buffers);
    const KickDrift row{};
    tear.mirror_f64({model, {}, row, 0}, buffers);
    State after = state;
    after.broken_links = buffers.words_of(BufferId::broken_links);
    EXPECT_NE(after.broken_links, state.broken_links) << "or nothing breaks";
    EXPECT_LT(energy(model, after).total(), energy(model, state).total());
    for (std::size_t p = 0; p < after.broken_links.size(); ++p)
      EXPECT_EQ(after.broken_links[p] & state.broken_links[p], state.broken_links[p]) << "broken is for good";
  }
}

/// The state after so many kicks and drifts by one pass. The buffers have no words that say which pass is to
/// move the cloth: integrate_torn then always does, and integrate where the scene has no tearing.
template <class T>
State moved_by(const Pass& pass, const Model& model, std::uint32_t substeps) {
  constexpr double kSubstep_s = 1.0 / (60 * 200);
  HostBuffers<T> buffers;
  if (model.scene.tearing) buffers.words_of(BufferId::broken_links).resize(model.grid.count());
  if (pass.name.ends_with("compensated")) buffers[BufferId::compensation].resize(2 * model.grid.count());
  State state = start_state(model);
  shake(state, 0.003, 0.1, 17);
  load_state(model, state, buffers);
  const Constants constants = pass.constants(model);
  for (std::uint32_t k = 0; k < substeps; ++k) {
    const KickDrift row{.kick_s = kSubstep_s, .drift_s = kSubstep_s};
    if constexpr (std::is_same_v<T, float>)
      pass.mirror_f32({model, constants, row, k}, buffers);
    else
      pass.mirror_f64({model, constants, row, k}, buffers);
    std::swap(buffers[BufferId::position], buffers[BufferId::position_next]);
    std::swap(buffers[BufferId::velocity], buffers[BufferId::velocity_next]);
  }
  return store_state(buffers, 0.0);
}

// With nothing broken, integrate_torn has integrate's bits: which of the two moves a whole cloth is no
// matter.
TEST(Tearing, WhatIsWholeHasItsBits) {
  for (const double damping_s : {0.0, 1e-4}) {
    Scene scene = torn_scene(10.0);
    scene.material.damping_s = damping_s;
    scene.pins = {{{0.0, 0.0}, 0.04}};
    scene.gravity = GravitySection{};
    scene.air = AirSection{0.1};
    const Model torn = build_model(scene);
    scene.tearing.reset();
    const Model whole = build_model(scene);
    const auto expect_equal = [&]<class T>(T, const Pass& one, const Pass& other) {
      EXPECT_EQ(state_hash(moved_by<T>(one, torn, 400)), state_hash(moved_by<T>(other, whole, 400)))
          << one.name << " " << damping_s << " " << sizeof(T);
    };
    expect_equal(0.0f, integrate_torn, integrate);
    expect_equal(0.0, integrate_torn, integrate);
    expect_equal(0.0f, integrate_torn_compensated, integrate_compensated);
  }
}

// And `integrate`, which moves it, is the same pass whether the cloth may tear or not.
TEST(Tearing, AClothThatNeverTearsMovesAsIfItCouldNot) {
  Scene scene = torn_scene(10.0);
  scene.pins = {{{0.0, 0.0}, 0.04}};
  scene.gravity = GravitySection{};
  const Model tearing = build_model(scene);
  scene.tearing.reset();
  const Model whole = build_model(scene);
  for (const char* solver : {"leapfrog", "symplectic-euler"})
    for (const char* precision : {"f32", "f32k"}) {
      const auto end = [&](const Model& m) {
        return state_hash(run_frames(m, start_state(m), solver, precision, 4, 1.0 / 60, 200));
      };
      EXPECT_EQ(end(tearing), end(whole)) << solver << " " << precision;
    }
}

// Cut along a column, two pieces know nothing of each other: the left one moves as if the right stood still.
TEST(Tearing, ACutThroughMakesTwoCloths) {
  const Model model = build_model(torn_scene(10.0));
  const Grid& grid = model.grid;
  State state = start_state(model);
  state.broken_links.assign(grid.count(), 0);
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    state.broken_links[grid.index(4, j)] = shared::kLinkAlongI | shared::kLinkFalling | shared::kLinkRising;
  shake(state, 0.01, 0.1, 3);
  State other = state;
  for (std::uint32_t p = 0; p < grid.count(); ++p)
    if (p % grid.nx > 4) other.position[p] += glm::dvec3(0.3, 0.1, 0.2);
  const State a = run_frames(model, state, "leapfrog", "f64", 3, 1.0 / 60, 200);
  const State b = run_frames(model, other, "leapfrog", "f64", 3, 1.0 / 60, 200);
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i <= 4; ++i)
      ASSERT_EQ(a.position[grid.index(i, j)], b.position[grid.index(i, j)]) << i << ", " << j;
  EXPECT_GT(glm::distance(a.position[8], b.position[8]), 0.1);
}

// A strip whose ends are drawn apart holds up to its strain and no farther, and momentum stays with each
// half.
TEST(Tearing, AStripBreaksAtItsStrain) {
  Scene scene = bare_scene(3, 17, 0.05);
  scene.tearing = TearingSection{0.2};
  scene.pins = {{.at = {0.5, 0.0}, .radius_m = 0.06},
                {.at = {0.5, 1.0}, .radius_m = 0.06, .keys = {{0.0, {0, 0, 0}}, {1.0, {0, -0.4, 0}}}}};
  const Model model = build_model(scene);
  const std::uint32_t n = substeps_per_frame(model, find_solver("leapfrog"));
  const auto broken = [&](int frames) {
    const State end = run_frames(model, start_state(model), "leapfrog", "f32", frames, 1.0 / 60, n);
    return std::ranges::count_if(end.broken_links, [](std::uint32_t word) { return word != 0; });
  };
  EXPECT_EQ(broken(9), 0) << "7.5 % on average at 0.15 s";
  EXPECT_GT(broken(60), 0) << "50 % at 1 s";
}

/// Change of velocity [m/s] of every particle by the air on the whole triangles in a kick of 1 s, in double.
std::vector<glm::dvec3> change_by_air(const Model& model, const State& state) {
  HostBuffers<double> buffers;
  buffers.words_of(BufferId::broken_links).resize(model.grid.count());
  load_state(model, state, buffers);
  const KickDrift row{.kick_s = 1.0};
  aerodynamics_torn.mirror_f64({model, aerodynamics_torn.constants(model), row, 0}, buffers);
  std::vector<glm::dvec3> result;
  for (std::size_t p = 0; p < state.velocity.size(); ++p)
    result.push_back(glm::dvec3(buffers[BufferId::velocity_next][p]) - state.velocity[p]);
  return result;
}

// The air takes hold of triangles: of none once every link is gone, and a tear changes what happens to the
// corners of the two triangles beside it and to nobody else.
TEST(Tearing, TheAirGoesThroughTheHole) {
  Scene scene = torn_scene(10.0);
  scene.wind = WindSection{.velocity_m_s = {3.0, 1.0, 2.0}};
  scene.aerodynamics = AerodynamicsSection{};
  const Model model = build_model(scene);
  const Grid& grid = model.grid;
  State state = start_state(model);
  shake(state, 0.01, 0.5, 7);
  state.broken_links.assign(grid.count(), 0);
  const std::vector<glm::dvec3> whole = change_by_air(model, state);
  state.broken_links[grid.index(4, 3)] = shared::kLinkRising;  // between A and B of the cell at (4, 3)
  const std::vector<glm::dvec3> torn = change_by_air(model, state);
  for (std::uint32_t p = 0; p < grid.count(); ++p) {
    const std::uint32_t i = p % grid.nx, j = p / grid.nx;
    const bool corner = (i == 4 || i == 5) && (j == 3 || j == 4);
    EXPECT_EQ(torn[p] != whole[p], corner) << i << ", " << j;
  }
  state.broken_links.assign(grid.count(), 15u);
  for (const glm::dvec3& change : change_by_air(model, state)) EXPECT_EQ(change, glm::dvec3(0.0));
}

TEST(Tearing, IsRefusedWhereThereIsNoPassForIt) {
  const auto plan_of = [](const Scene& s, const char* solver, const char* precision) {
    return compile_plan(build_model(s), find_solver(solver), precision);
  };
  Scene scene = torn_scene(0.3);
  EXPECT_THROW(plan_of(scene, "xpbd", "f32"), Error);
  EXPECT_THROW(plan_of(scene, "rk4", "f32"), Error);
  const Plan torn = plan_of(scene, "leapfrog", "f32");
  scene.tearing.reset();
  const Plan whole = plan_of(scene, "leapfrog", "f32");
  // 4 B a link word, 24 B a cell and 24 B a particle of indices, 32 B of limits; 19 words of workgroups, and
  // in the table what asks whether a link is near its limit, three vectors a substep.
  const std::uint64_t rows = std::uint64_t{kFrameSlots} * substep_row_capacity(torn.row_count());
  EXPECT_EQ(torn.bytes() - whole.bytes(), 72u * 4 + 24u * (8 * 7 + 72) + 32 + 19 * 4 + rows * 48);
  scene.tearing = TearingSection{0.3};
  scene.material.strain_limit = 0.1;
  EXPECT_THROW(plan_of(scene, "leapfrog", "f32"), Error);
}

}  // namespace
}  // namespace weft
