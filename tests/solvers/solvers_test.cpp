// Finding solvers, their schedules, step rules and the automatic number of substeps.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "scene/parameters.h"
#include "solvers/solver.h"
#include "support/cloth.h"

namespace weft {
namespace {

using namespace testing_support;

TEST(Solvers, AreFoundByName) {
  for (const Solver* solver : solvers()) {
    EXPECT_EQ(&find_solver(solver->name), solver);
    EXPECT_FALSE(solver->about.empty());
    EXPECT_FALSE(solver->source.empty());
  }
  EXPECT_EQ(solvers()[0]->name, "leapfrog");
}

TEST(Solvers, AnUnknownNameListsTheValidOnes) {
  try {
    find_solver("leapfog");
    FAIL() << "accepted";
  } catch (const Error& refused) {
    EXPECT_EQ(refused.code(), Exit::usage);
    for (const Solver* solver : solvers())
      EXPECT_NE(std::string(refused.what()).find(solver->name), std::string::npos) << refused.what();
  }
}

// Kicks and drifts each add up to the frame; the ends have half kicks; the closing kick does not drift.
TEST(Leapfrog, ScheduleIsAsStated) {
  const auto rows = find_solver("leapfrog").schedule(2.0, 0.1, 4);
  ASSERT_EQ(rows.size(), 5u);
  double kicks_s = 0.0, drifts_s = 0.0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_DOUBLE_EQ(rows[k].kick_s, k == 0 || k == 4 ? 0.0125 : 0.025);
    EXPECT_DOUBLE_EQ(rows[k].kick_time_s, 2.0 + 0.025 * double(k));
    EXPECT_DOUBLE_EQ(rows[k].drift_time_s, rows[k].kick_time_s);
    kicks_s += rows[k].kick_s;
    drifts_s += rows[k].drift_s;
  }
  EXPECT_EQ(rows.back().drift_s, 0.0);
  EXPECT_NEAR(kicks_s, 0.1, 1e-15);
  EXPECT_NEAR(drifts_s, 0.1, 1e-15);
  EXPECT_EQ(find_solver("leapfrog").schedule(0.0, 0.1, 1).size(), 2u);
}

// Undamped, leapfrog's limit is 2/ω; with damping alone 2/γ. RK4: 1.3 times that.
TEST(StepRule, HasTheKnownLimits) {
  const auto leapfrog = find_solver("leapfrog").step_max_s, rk4 = find_solver("rk4").step_max_s;
  EXPECT_DOUBLE_EQ(leapfrog({1e6, 0.0}), 2e-3);
  EXPECT_DOUBLE_EQ(leapfrog({0.0, 1e3}), 2e-3);
  EXPECT_DOUBLE_EQ(rk4({1e6, 0.0}), 2.6e-3);
  EXPECT_DOUBLE_EQ(leapfrog({1e6, 3e3}), 4.0 / (3e3 + std::sqrt(13e6)));
  EXPECT_TRUE(std::isinf(leapfrog({0.0, 0.0})));
}

Scene reference_cloth(std::uint32_t resolution, double damping_s) {
  Scene scene;
  scene.cloth.resolution = resolution;
  scene.material.bend_n_m = 2e-5;
  scene.material.damping_s = damping_s;
  return scene;
}

// The scene reader refuses other names with file and line; it cannot see the solvers, so it has their names.
TEST(Solvers, AreTheNamesThatASceneMayGive) {
  std::string names;
  for (const Solver* solver : solvers()) names += (names.empty() ? "" : "|") + std::string(solver->name);
  EXPECT_EQ(find_parameter("solver", "name")->words, names);
}

// docs/physics.md: Y = 1000, ρ = 0.2, 1 m, ζ = 0.1, B = 2e-5.
TEST(Substeps, AreTheStatedNumbers) {
  struct Row {
    std::uint32_t resolution;
    double damping_s;
    std::uint32_t substeps;
  };
  for (const Row& row : {Row{64, 1e-4, 157}, Row{256, 1e-4, 642}, Row{1024, 1e-4, 2646}, Row{64, 0, 116},
                         Row{256, 0, 470}, Row{1024, 0, 1958}})
    EXPECT_EQ(substeps_per_frame(build_model(reference_cloth(row.resolution, row.damping_s)),
                                 find_solver("leapfrog")),
              row.substeps)
        << row.resolution;
}

TEST(Substeps, ThatTheSceneSaysAreTaken) {
  Scene scene = reference_cloth(16, 1e-4);
  scene.solver.substeps = 7;
  EXPECT_EQ(substeps_per_frame(build_model(scene), find_solver("leapfrog")), 7u);
}

TEST(Substeps, OfNothingStiffAreOne) {
  Scene scene = reference_cloth(8, 1e-4);
  scene.pins = {{{0.5, 0.5}, 1.0}};  // all of it
  EXPECT_EQ(substeps_per_frame(build_model(scene), find_solver("leapfrog")), 1u);
}

TEST(Substeps, BeyondReasonAreRefused) {
  Scene scene = reference_cloth(512, 0.0);
  scene.material.membrane_n_m = 1e15;
  try {
    substeps_per_frame(build_model(scene), find_solver("leapfrog"));
    FAIL() << "accepted";
  } catch (const Error& refused) {
    EXPECT_EQ(refused.code(), Exit::usage);
  }
}

}  // namespace
}  // namespace weft
