// Several cloths in one scene: apart, each moves as if it were alone; together, they keep off each other.
#include "support/cloths.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "scenes.h"
#include "sim/host_simulation.h"
#include "sim/simulation.h"
#include "support/closest_pair.h"
#include "support/crossings.h"

namespace weft::test {
namespace {

using testing_support::alone;
using testing_support::crossing_count;
using testing_support::part_of;

/// Three cloths far apart of 11 x 9 particles, numbers that no colour of XPBD's divides, each held otherwise.
constexpr const char* kApart = R"(
[cloth]
resolution = 11
height = 0.8
center = [0, 1, 0]
imperfection = 0.01
[[cloths]]
center = [5, 1, 0]
orientation = "horizontal"
[[cloths]]
center = [0, 1, 5]
imperfection = 0.02
[material]
bend = 1e-4
membrane_warp = 800
[[pins]]
at = [0, 0]
[[pins]]
at = [1, 0]
cloth = 1
[[pins]]
at = [0, 1]
cloth = 1
release = 0.01
[gravity]
[air]
drag = 0.2
[wind]
velocity = [0.5, 0.0, 3.0]
[[spheres]]
center = [5, 0.9, 0]
radius = 0.11
friction = 0.3
[[spheres]]
center = [0, 0.9, 4.8]
radius = 0.22
[floor]
height = 0.62
[solver]
substeps = 48
)";

Scene apart(const std::string& more = "") { return parse_scene(kApart + more, "apart.toml").scene; }

State ran(const Scene& scene, const char* solver, const char* precision, int frames) {
  const Model model = build_model(scene);
  const auto simulation = make_cpu_simulation(model, find_solver(solver), precision);
  for (int f = 0; f < frames; ++f) simulation->advance(scene.solver.frame_s, simulation->plan().substeps);
  return simulation->read();
}

void expect_each_alone(const Scene& scene, const char* solver, const char* precision, int frames = 2) {
  const Grid grid = build_grid(scene);
  ASSERT_EQ(grid.cloths, 3u);
  const State all = ran(scene, solver, precision, frames);
  for (std::uint32_t k = 0; k < grid.cloths; ++k)
    expect_same(part_of(grid, all, k), ran(alone(scene, k), solver, precision, frames),
                fmt::format("{} {}, cloth {}", solver, precision, k));
}

// Nothing joins two cloths: not a bit of one may depend on another that is out of reach.
TEST(Cloths, far_apart_move_to_the_bit_as_if_each_were_alone) {
  for (const char* solver : {"leapfrog", "velocity-verlet", "verlet", "euler"})
    expect_each_alone(apart(), solver, "f32");
  for (const char* solver : {"leapfrog", "rk4", "trapezoid"}) expect_each_alone(apart(), solver, "f64");
  Scene still = apart();  // XPBD's pins do not let go
  for (PinSection& pin : still.pins) pin.release_s.reset();
  expect_each_alone(still, "xpbd", "f32");
  expect_each_alone(apart(), "leapfrog", "f32k");
}

TEST(Cloths, far_apart_have_their_own_air_strain_limit_and_self_collision) {
  expect_each_alone(apart("[aerodynamics]\n"), "leapfrog", "f32");
  // So thin that every substep looks at contacts, alone and together: how far one may fall on another
  // matters.
  expect_each_alone(apart("[self_collision]\nthickness = 0.005\n"), "leapfrog", "f32");
  Scene limited = apart();
  limited.material.strain_limit = 0.001;
  expect_each_alone(limited, "leapfrog", "f32");
}

// Which is called the first changes nothing for any of them.
TEST(Cloths, do_not_depend_on_their_order) {
  const Scene scene = apart("[self_collision]\nthickness = 0.03\n");
  Scene turned = scene;
  turned.cloth = cloth_of(scene, 2);
  const ClothSection first = cloth_of(scene, 0);
  turned.cloths[1] = {first.center_m, first.orientation, first.imperfection_m};
  turned.cloths[0].orientation = cloth_of(scene, 1).orientation;
  turned.cloths[0].imperfection_m = cloth_of(scene, 1).imperfection_m;
  for (PinSection& pin : turned.pins) pin.cloth = 2 - pin.cloth;
  const Grid grid = build_grid(scene);
  const State a = ran(scene, "leapfrog", "f32", 3), b = ran(turned, "leapfrog", "f32", 3);
  for (std::uint32_t k = 0; k < 3; ++k)
    expect_same(part_of(grid, b, 2 - k), part_of(grid, a, k), fmt::format("cloth {}", k));
}

// Two free sheets, 3 cm apart, at 1.2 m/s against each other: what one gains the other loses. In double, sums
// of some hundred terms agree to 1e-14 of their size.
TEST(Cloths, keep_their_momentum_when_they_meet) {
  const Scene scene = parse_scene(R"(
[cloth]
resolution = 16
orientation = "horizontal"
[[cloths]]
center = [0.02, 0.09, 0.01]
[material]
membrane = 200.0
[self_collision]
thickness = 0.06
)",
                                  "meeting.toml")
                          .scene;
  const Model model = build_model(scene);
  State start = start_state(model);
  const std::size_t half = start.position.size() / 2;
  for (std::size_t p = 0; p < start.position.size(); ++p)
    start.velocity[p] = {0.3, p < half ? 0.0 : -1.2, 0.1};
  const glm::dvec3 before = linear_momentum(model, start);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f64");
  simulation->write(start);
  for (int f = 0; f < 8; ++f) simulation->advance(scene.solver.frame_s, simulation->plan().substeps);
  const State end = simulation->read();
  EXPECT_LE(glm::distance(linear_momentum(model, end), before), 1e-13 * glm::length(before));
  glm::dvec3 upper(0.0);
  for (std::size_t p = half; p < end.position.size(); ++p) upper += end.velocity[p] / double(half);
  EXPECT_GT(upper.y, -0.9) << "they did not meet";  // perfectly inelastic: -0.6
}

/// A cloth held at its corners, and one dropped on it from 15 cm.
Scene dropped(bool collides) {
  return parse_scene(fmt::format(R"(
[cloth]
resolution = 20
orientation = "horizontal"
center = [0, 1, 0]
imperfection = 0.005
[[cloths]]
center = [0.1, 1.15, 0.05]
[material]
membrane = 400.0
bend = 1e-4
[[pins]]
at = [0, 0]
[[pins]]
at = [1, 0]
[[pins]]
at = [0, 1]
[[pins]]
at = [1, 1]
[gravity]
[air]
drag = 0.2
{}
)",
                                 collides ? "[self_collision]\nthickness = 0.06\n" : ""),
                     "dropped.toml")
      .scene;
}

/// The most crossings that any frame has.
std::size_t most_crossings(const Scene& scene, int frames) {
  const Model model = build_model(scene);
  const auto simulation = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  std::size_t most = 0;
  for (int f = 0; f < frames; ++f) {
    simulation->advance(scene.solver.frame_s, simulation->plan().substeps);
    most = std::max(most, crossing_count(model.grid, simulation->read().position));
  }
  return most;
}

// The thickness is somewhat more than a cell, so that particles alone close the cloths to each other.
TEST(Cloths, one_dropped_on_another_stays_above_it) {
  EXPECT_EQ(most_crossings(dropped(true), 60), 0u);
  EXPECT_GT(most_crossings(dropped(false), 20), 0u) << "nothing to hold in this test";
}

// Two cloths of 4 rows have the buffers and ranges of one of 8, and are not the same plan.
TEST(Cloths, are_not_taken_for_one_cloth_of_as_many_rows) {
  Scene one =
      parse_scene("[cloth]\nresolution = 8\nheight = 1\n[gravity]\n[[pins]]\nat = [0, 0]\n", "one.toml")
          .scene;
  Scene two = one;
  two.cloth.height_m = 3.0 / 7.0;
  two.cloths = {{.center_m = {3.0, 0.0, 0.0}}};
  one.solver.substeps = two.solver.substeps = 20;
  const Model as_one = build_model(one), as_two = build_model(two);
  ASSERT_EQ(as_one.grid.rows(), as_two.grid.rows());
  const auto simulation = make_host_reference(as_one, find_solver("leapfrog"), "f32");
  EXPECT_EQ(simulation->plan().bytes(), compile_plan(as_two, find_solver("leapfrog")).bytes());
  EXPECT_FALSE(simulation->adopt(as_two));
}

TEST(Cloths, refuse_what_is_for_one_cloth) {
  Scene torn = apart("[tearing]\nstrain = 0.5\n");
  const Scene still = apart("[tethers]\n");
  for (const Scene& scene : {torn, still}) {
    const char* solver = scene.tethers ? "xpbd" : "leapfrog";
    try {
      compile_plan(build_model(scene), find_solver(solver));
      FAIL() << "accepted";
    } catch (const Error& refused) {
      EXPECT_EQ(refused.code(), Exit::usage);
      EXPECT_NE(std::string(refused.what()).find("stands beside [[cloths]]"), std::string::npos)
          << refused.what();
    }
  }
}

}  // namespace
}  // namespace weft::test
