// Layers never pass through each other: crossings of edges and triangles, counted exactly, are none at every
// frame's end; and what the guarantee costs in substeps, friction between layers, the smallest gap.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "model/measures.h"
#include "passes/collision.h"
#include "sim/simulation.h"
#include "solvers/solver.h"
#include "support/crossings.h"
#include "support/layers.h"

namespace weft::test {
namespace {

using namespace testing_support;

struct LayersRun {
  std::size_t crossings = 0;
  double gap_m = 1e300;
  SelfCollisionReport report;
  State end;
};

/// Crossings at every frame's end, added up, and the smallest gap reported.
LayersRun run_layers(const LayeredScene& scene, int frames) {
  const auto simulation = make_cpu_simulation(scene.model, find_solver("leapfrog"), "f32");
  simulation->write(scene.start);
  LayersRun run;
  for (int f = 0; f < frames; ++f) {
    simulation->advance(scene.model.scene.solver.frame_s, simulation->plan().substeps);
    run.end = simulation->read();
    run.crossings += crossing_count(scene.model.grid, run.end.position);
    if (!scene.model.scene.self_collision) continue;
    run.report = *simulation->self_collision();
    if (run.report.smallest_gap_m) run.gap_m = std::min(run.gap_m, *run.report.smallest_gap_m);
  }
  return run;
}

void expect_apart(const LayersRun& run) {
  EXPECT_EQ(run.crossings, 0u);
  EXPECT_EQ(run.report.pairs_dropped, 0u);
  EXPECT_GT(run.gap_m, 0.0);
  EXPECT_LT(run.gap_m, 1.0) << "no layers came near each other: nothing is tested";
}

TEST(SelfSurface, keeps_a_sheet_folded_flat_from_crossing_itself) {
  LayeredScene scene = folded_sheet(13, 0.05);
  expect_apart(run_layers(scene, 20));
  scene.model.scene.self_collision.reset();
  EXPECT_GT(run_layers({build_model(scene.model.scene), scene.start}, 20).crossings, 0u)
      << "without self-collision it does not cross either: nothing is tested";
}

TEST(SelfSurface, keeps_layers_that_drop_from_crossing) {
  expect_apart(run_layers(folded_strip(8, 4, 0.3), 20));
}

TEST(SelfSurface, keeps_layers_pressed_between_sphere_and_floor_from_crossing) {
  const double deep_m = 0.2 + 0.55 / 12;  // room for two layers and a tenth more
  expect_apart(run_layers(folded_sheet(13, 0.03,
                                       fmt::format("[[spheres]]\nradius = 0.2\nfriction = 0.3\nkeys = [ "
                                                   "{{ time = 0, center = [-0.2, 0.4, 0] }}, "
                                                   "{{ time = 0.2, center = [-0.2, {0}, 0] }}, "
                                                   "{{ time = 0.4, center = [-0.2, {0}, 0] }} ]\n",
                                                   deep_m)),
                          24));
}

// At the design speed a particle moves by at most half the distance that surfaces keep, in one substep; where
// stability alone would take fewer substeps, there are more.
TEST(SelfSurface, takes_substeps_in_which_nothing_moves_by_half_its_thickness) {
  bool raised = false;
  for (const double thickness_m : {0.05, 0.01, 0.002, 0.0005}) {
    const Model model =
        layered_model("[cloth]\nresolution = 17\norientation = \"horizontal\"\n", thickness_m, "");
    Scene alone = model.scene;
    alone.self_collision.reset();
    const std::uint32_t n = substeps_per_frame(model, find_solver("leapfrog")),
                        stable = substeps_per_frame(build_model(alone), find_solver("leapfrog"));
    const double limit_m = std::min(thickness_m, 0.25 / 16);
    EXPECT_LE(design_speed_m_s(model) * model.scene.solver.frame_s / n, limit_m / 2);
    EXPECT_GE(n, stable);
    raised |= n > stable;
  }
  EXPECT_TRUE(raised);
}

// A half that slides over the other at 1 m/s and falls on it comes with it the more the rougher they are.
TEST(SelfSurface, lets_friction_slow_a_sliding_layer) {
  double apart_m_s[2] = {};
  for (const int rough : {0, 1}) {
    LayeredScene scene = folded_sheet(17, 1.0);
    scene.model.scene.self_collision->friction = rough;
    scene.model = build_model(scene.model.scene);
    const Grid& grid = scene.model.grid;
    for (std::uint32_t p = 0; p < grid.count(); ++p)
      if (p % grid.nx > grid.nx / 2) scene.start.velocity[p] = {0.0, -1.0, 1.0};
    const LayersRun run = run_layers(scene, 3);
    for (std::uint32_t p = 0; p < grid.count(); ++p)
      if (p % grid.nx != grid.nx / 2)
        apart_m_s[rough] += run.end.velocity[p].z * (p % grid.nx > grid.nx / 2 ? 1 : -1) / (grid.count() / 2);
  }
  EXPECT_LT(apart_m_s[1], 0.8 * apart_m_s[0]);
}

}  // namespace
}  // namespace weft::test
