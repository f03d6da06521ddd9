// Self-collision as a whole: pairs keep their limit, momentum stays, an idle effect touches nothing, and the
// device ends in the reference's bits.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.h"
#include "gpu_fixture.h"
#include "model/measures.h"
#include "passes/collision.h"
#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "sim/validate.h"
#include "support/closest_pair.h"

namespace weft::test {
namespace {

using testing_support::closest_pair;

constexpr const char* kThickness = "\n[self_collision]\nthickness = 0.02\n";

/// A free square sheet of cells of a thirtieth of a metre.
Model sheet(const std::string& more) {
  return build_model(parse_scene("[cloth]\nresolution = 31\norientation = \"horizontal\"\n"
                                 "[material]\nmembrane = 200.0\nbend = 1e-5\n" +
                                     more,
                                 "sheet.toml")
                         .scene);
}

/// The sheet folded flat on itself along its middle column: the upper half `gap_m` above the lower, shifted
/// by a third of a cell, so that particles face gaps.
State folded(const Model& model, double gap_m) {
  State state = start_state(model);
  const Grid& grid = model.grid;
  const double a = grid.spacing_m;
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i) {
      glm::dvec3& x = state.position[grid.index(i, j)];
      if (const double over = i * a - grid.width_m() / 2; over > 0) {
        x.x -= 2 * over - a / 3;
        x.y += gap_m;
      }
    }
  return state;
}

/// Whole frames.
void run(Simulation& simulation, int frames) {
  for (int f = 0; f < frames; ++f)
    simulation.advance(simulation.model().scene.solver.frame_s, simulation.plan().substeps);
}

// docs/physics.md "Self-collision": never less than sin(1) = 84 % of min(thickness, flat distance), always
// less than the flat distance, the thickness itself from half a turn of a fold on.
TEST(PairLimit, stays_between_84_percent_and_the_flat_distance) {
  for (int k = 1; k <= 300; ++k) {
    const double flat_m = 0.01 * k, limit_m = pair_limit_m(1.0, flat_m);
    EXPECT_GE(limit_m, 0.841 * std::min(1.0, flat_m));
    EXPECT_LT(limit_m, flat_m);
    EXPECT_LE(limit_m, 1.0);
    if (flat_m > 1.571) {
      EXPECT_DOUBLE_EQ(limit_m, 1.0);
    }
  }
}

// A flat cloth has no pair nearer than its limit, however fine it is for its thickness: not a bit may change.
TEST(SelfCollision, leaves_an_isolated_flat_cloth_alone_to_the_bit) {
  for (const char* thickness : {"0.02", "0.1", "0.3"}) {
    const std::string rest = "[gravity]\n[air]\ndrag = 0.1\n";
    const Model with = sheet(rest + "[self_collision]\nthickness = " + thickness + "\n"),
                without = sheet(rest);
    const auto a = make_cpu_simulation(with, find_solver("leapfrog"), "f32");
    const auto b = make_cpu_simulation(without, find_solver("leapfrog"), "f32");
    run(*a, 3);
    run(*b, 3);
    expect_same(a->read(), b->read(), thickness);
    // It falls as a whole: nothing moves against the rest. Each frame begins with lists of its own.
    EXPECT_EQ(a->self_collision()->lists_built, 3u);
    EXPECT_FALSE(a->self_collision()->smallest_gap_m.has_value());
    EXPECT_FALSE(b->self_collision().has_value());
  }
}

// Two halves at 0.4 m/s against each other, held by nothing else: what one gains the other loses. Slow enough
// for nothing to be held back, which alone does not keep momentum.
TEST(SelfCollision, keeps_momentum_and_the_centre_of_mass_in_free_flight) {
  Scene limp = sheet(kThickness).scene;
  limp.material.flex = 0.0;  // what springs over two cells hold would throw the fold open
  const Model model = build_model(limp);
  State start = folded(model, 0.745 * model.grid.spacing_m);  // no edge of the fold is stretched
  for (std::size_t p = 0; p < start.position.size(); ++p)
    start.velocity[p] = {0.3, start.position[p].y > 0.02 ? -0.4 : 0.0, 0.1};
  for (const auto& [precision, tolerance] : {std::pair{"f64", 1e-14}, {"f32", 2e-6}}) {
    const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), precision);
    simulation->write(start);
    const glm::dvec3 before = linear_momentum(model, start);
    double closest = 1e300;
    for (int frame = 0; frame < 12; ++frame) {
      run(*simulation, 1);
      closest = std::min(closest, closest_pair(model, simulation->read()).ratio);
    }
    const State end = simulation->read();
    EXPECT_LE(glm::distance(linear_momentum(model, end), before), tolerance * glm::length(before) * 10);
    EXPECT_LT(closest, 1.001);  // they met
    EXPECT_EQ(simulation->self_collision()->held_back, 0u);
  }
}

// Folded flat at 1.5 thicknesses and dropped on the floor: the layers come to rest on each other, not in.
TEST(SelfCollision, keeps_a_folded_cloth_apart) {
  const Model model =
      sheet(std::string("[gravity]\n[air]\ndrag = 0.2\n[floor]\nheight = -0.1\n") + kThickness);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  simulation->write(folded(model, 0.03));
  run(*simulation, 120);
  const auto closest = closest_pair(model, simulation->read());
  EXPECT_GE(closest.ratio, 0.8) << closest.a << " and " << closest.b;
  EXPECT_EQ(simulation->self_collision()->pairs_dropped, 0u);

  const Model bare = sheet("[gravity]\n[air]\ndrag = 0.2\n[floor]\nheight = -0.1\n");
  const auto through = make_cpu_simulation(bare, find_solver("leapfrog"), "f32");
  through->write(folded(model, 0.03));
  run(*through, 120);
  EXPECT_LT(closest_pair(model, through->read()).ratio, 0.8) << "nothing to keep apart in this test";
}

// The lists hold every pair that can touch, so the bits do not depend on when they were made.
TEST(SelfCollision, forgets_its_lists_without_a_trace) {
  const Model model = sheet(std::string("[gravity]\n[floor]\nheight = -0.05\n") + kThickness);
  const auto straight = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  straight->write(folded(model, 0.015));
  run(*straight, 6);
  const State middle = straight->read();
  run(*straight, 4);
  const auto resumed = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  resumed->write(middle);
  run(*resumed, 4);
  EXPECT_LT(closest_pair(model, folded(model, 0.015)).ratio, 1.0);
  EXPECT_LT(closest_pair(model, middle).ratio, 1.01);
  expect_same(resumed->read(), straight->read(), "resumed");
}

// 961 particles in one point find no room for each other: said, not hidden; and nothing is ever not a number.
TEST(SelfCollision, reports_pairs_without_room) {
  const Model model = sheet(kThickness);
  State state = start_state(model);
  for (glm::dvec3& x : state.position) x = glm::dvec3(0.1) + 1e-4 * x;
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  simulation->write(state);
  simulation->advance(1e-5, 1);
  const std::uint32_t room = collision_layout(model).capacity * model.grid.count();
  EXPECT_GE(simulation->self_collision()->pairs_dropped, 961u * 960u - room);
  for (const glm::dvec3& x : simulation->read().position) EXPECT_TRUE(std::isfinite(x.x));
}

TEST(SelfCollision, refuses_a_thickness_of_more_than_ten_cells) {
  const Model model = sheet("[self_collision]\nthickness = 0.5\n");
  EXPECT_THROW(compile_plan(model, find_solver("leapfrog")), Error);
}

class SelfCollisionOnGpu : public GpuTest {};

TEST_F(SelfCollisionOnGpu, ends_in_the_reference_s_bits_and_in_the_same_twice) {
  if (!device().info().software) GTEST_SKIP() << "exact on software devices only";
  const Model model = sheet(std::string("[gravity]\n[floor]\nheight = -0.05\nfriction = 0.3\n"
                                        "[[pins]]\nat = [0.5, 0.5]\n") +
                            kThickness + "friction = 0.3\n");
  const auto cpu = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  cpu->write(folded(model, 0.015));
  run(*cpu, 8);
  EXPECT_LT(closest_pair(model, cpu->read()).ratio, 1.0);
  for (const std::uint32_t cut : {0u, 37u}) {
    const auto gpu =
        GpuSimulation::create(device(), model, find_solver("leapfrog"), {.dispatches_per_submit = cut});
    gpu->write(folded(model, 0.015));
    run(*gpu, 8);
    expect_same(gpu->read(), cpu->read(), "8 frames");
    EXPECT_EQ(gpu->self_collision()->lists_built, cpu->self_collision()->lists_built);
    EXPECT_GT(gpu->self_collision()->lists_built, 1u);
    EXPECT_EQ(gpu->bytes_allocated(), gpu->bytes_expected());
  }
}

TEST_F(SelfCollisionOnGpu, validates_every_pass_with_layers_that_touch) {
  const Model model = scene_model("5", {.set = {"cloth.resolution=24", "self_collision.thickness=0.03"}});
  const ValidationReport report = validate(device(), model, find_solver("leapfrog"), {.lockstep_frames = 1});
  std::set<std::string> checks;
  bool touching = false;
  for (const ValidationRow& row : report.rows) {
    checks.insert(row.check);
    touching |= row.state == "folded" && row.check == "self_contact";
    EXPECT_TRUE(row.ok) << row.check << ", " << row.state << ", " << row.buffer << ": " << row.verdict;
  }
  EXPECT_TRUE(touching);
  for (const char* pass :
       {"carry", "surface_gather", "surface_touch", "surface_contact", "pair_check", "cell_count",
        "cell_scan", "cell_fill", "cell_sort", "patch_near", "pair_gather", "touch_weight", "self_contact"})
    EXPECT_TRUE(checks.contains(pass)) << pass;
}

}  // namespace
}  // namespace weft::test
