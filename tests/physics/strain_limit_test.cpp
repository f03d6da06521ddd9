// The strain limit: what it holds, keeps and takes, and that it costs nothing where it is absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "model/springs.h"
#include "plan/buffers.h"
#include "shared/reach.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

constexpr const char* kLimiting[] = {"leapfrog", "symplectic-euler", "xpbd"};

/// A metre of cloth so soft that it hangs 20 % long and more.
Scene soft_scene(double limit, std::string_view solver = "leapfrog") {
  Scene scene = bare_scene(17, 17, 1.0 / 16);
  scene.material.membrane_n_m = 6.0;
  scene.material.strain_limit = limit;
  scene.gravity = GravitySection{};
  scene.air = AirSection{0.6};
  scene.pins = {{{0.5, 0.0}, 0.51, {}}};
  scene.solver.name = solver;
  return scene;
}

/// The largest elongation of a structural or shear spring over its rest length.
double near_stretch(const Model& model, const State& state) {
  double most = 0.0;
  for_each_spring(model, [&](const SpringKind& kind, std::uint32_t a, std::uint32_t b, double) {
    if (std::abs(kind.di) == 2 || std::abs(kind.dj) == 2) return;
    most = std::max(most, glm::distance(state.position[a], state.position[b]) / kind.rest_m - 1.0);
  });
  return most;
}

glm::dvec3 momentum(const Model& model, const State& state) {
  glm::dvec3 sum(0.0);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) sum += state.velocity[p] / model.inverse_mass(p);
  return sum;
}

// The elastic law alone stretches the top by more than 20 %. One sweep a substep leaves what a substep's fall
// brings back: a fifth of the limit with 40 substeps.
TEST(StrainLimit, HoldsAHangingClothAtRest) {
  const Model free_model = build_model(soft_scene(0.0));
  const State free_end = run_frames(free_model, start_state(free_model), "leapfrog", "f32", 180, 1.0 / 60,
                                    substeps_per_frame(free_model, find_solver("leapfrog")));
  EXPECT_GT(near_stretch(free_model, free_end), 0.2) << "or there is nothing to limit";
  for (const char* solver : kLimiting) {
    const Model model = build_model(soft_scene(0.05, solver));
    const std::uint32_t n = std::max(40u, substeps_per_frame(model, find_solver(solver)));
    const State end = run_frames(model, start_state(model), solver, "f32", 180, 1.0 / 60, n);
    EXPECT_LE(near_stretch(model, end), 0.06) << solver;
    EXPECT_GT(near_stretch(model, end), 0.045) << solver << ": it limits, and does not shrink";
  }
}

// What one end gains the other loses.
TEST(StrainLimit, KeepsMomentumAndTheCentreOfMass) {
  for (const char* solver : kLimiting) {
    Scene scene = bare_scene(9, 9, 0.1);
    scene.material.strain_limit = 0.02;
    const Model model = build_model(scene);
    State start = start_state(model);
    shake(start, 0.03, 2.0, 3);  // springs of up to twice their length
    const auto simulation = make_cpu_simulation(model, find_solver(solver), "f64");
    simulation->write(start);
    for (int frame = 0; frame < 5; ++frame) simulation->advance(1.0 / 60, simulation->plan().substeps);
    const State end = simulation->read();
    EXPECT_LE(glm::length(momentum(model, end) - momentum(model, start)), 1e-13) << solver;
    glm::dvec3 moved(0.0), expected = momentum(model, start) * (5.0 / 60);
    for (std::uint32_t p = 0; p < model.grid.count(); ++p)
      moved += (end.position[p] - start.position[p]) / model.inverse_mass(p);
    EXPECT_LE(glm::length(moved - expected), 1e-13) << solver;
  }
}

// It takes energy and never gives any, from a start that is stretched everywhere, too.
TEST(StrainLimit, NeverCreatesEnergy) {
  Scene scene = bare_scene(13, 13, 0.05);
  scene.material.strain_limit = 0.03;
  const Model model = build_model(scene);
  State start = start_state(model);
  for (glm::dvec3& x : start.position) x *= 1.4;
  shake(start, 0.01, 3.0, 5);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f64");
  simulation->write(start);
  double before_j = energy(model, start).total();
  const double begun_j = before_j;
  for (int frame = 0; frame < 60; ++frame) {
    simulation->advance(1.0 / 60, simulation->plan().substeps);
    const double now_j = energy(model, simulation->read()).total();
    EXPECT_LE(now_j, before_j + 0.002 * begun_j) << "frame " << frame;  // leapfrog's own swing
    before_j = now_j;
  }
}

// Yanked by two corners, from which the whole weight then hangs by a few springs: the worst place there is.
// Sweeps pass the pull on by a few springs each, so that more substeps hold it closer.
TEST(StrainLimit, HoldsAtYankedCornersTheCloserTheMoreSubsteps) {
  const auto after_yank = [](double limit, std::uint32_t substeps) {
    Scene scene = soft_scene(limit);
    scene.pins = {{{0.0, 0.0}, 0.1, {{0.1, {0, 0, 0}}, {0.15, {0.2, 0, 3}}}},
                  {{1.0, 0.0}, 0.1, {{0.1, {0, 0, 0}}, {0.15, {-0.2, 0, 3}}}}};
    const Model model = build_model(scene);
    const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
    for (int frame = 0; frame < 240; ++frame) simulation->advance(1.0 / 60, substeps);
    const State end = simulation->read();
    EXPECT_TRUE(all_finite(end));
    return near_stretch(model, end);
  };
  const double without = after_yank(0.0, 40), coarse = after_yank(0.05, 40), fine = after_yank(0.05, 160);
  EXPECT_GT(without, 0.9);
  EXPECT_LE(coarse, 0.15);
  EXPECT_LE(fine, 0.065);
}

std::uint64_t bytes_of(const Plan& plan, BufferId id) {
  const auto at = std::ranges::find(plan.buffers, id, &PlanBuffer::id);
  return at == plan.buffers.end() ? 0 : at->bytes;
}

TEST(StrainLimit, IsInThePlanOnlyWhereTheMaterialHasOne) {
  for (const char* name : kLimiting) {
    const Plan without = compile_plan(build_model(soft_scene(0.0)), find_solver(name));
    for (const PlanStep& step : without.steps) EXPECT_NE(step.pass, &strain_limit) << name;
    const auto absent = std::ranges::find(without.left_out, "strain limit", &LeftOut::effect);
    ASSERT_NE(absent, without.left_out.end());
    EXPECT_EQ(absent->reason, "material.strain_limit is 0");
    const Plan with = compile_plan(build_model(soft_scene(0.05)), find_solver(name));
    EXPECT_EQ(with.steps.size(), without.steps.size() + 8u) << name << ": a dispatch a colour";
    // Two rows of limits; in the table what asks whether a link is near them, three vectors a substep; and
    // the workgroups, which only solvers have whose passes ask.
    const std::uint64_t rows = bytes_of(with, BufferId::substeps) - bytes_of(without, BufferId::substeps);
    const std::uint64_t capacity = kFrameSlots * substep_row_capacity(with.row_count());
    EXPECT_EQ(rows, capacity * shared::kRowReachVec4s * 16u) << name;
    const std::uint64_t groups = with.reaching.links ? shared::kReachWords * 4u : 0u;
    EXPECT_EQ(bytes_of(with, BufferId::reach_groups), groups) << name;
    EXPECT_EQ(with.bytes(), without.bytes() + 32u + rows + groups) << name;
  }
}

TEST(StrainLimit, SolversWithoutItRefuse) {
  for (const char* name : {"rk4", "verlet", "velocity-verlet", "euler", "trapezoid"}) {
    try {
      compile_plan(build_model(soft_scene(0.05)), find_solver(name));
      ADD_FAILURE() << name;
    } catch (const Error& refusal) {
      EXPECT_EQ(refusal.code(), Exit::usage);
      EXPECT_NE(std::string(refusal.what()).find("leapfrog, symplectic-euler, xpbd"), std::string::npos)
          << refusal.what();
    }
  }
}

}  // namespace
}  // namespace weft
