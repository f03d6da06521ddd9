// The acceptance of self-collision at its full size; minutes on a software device, so only in the long run.
#include <gtest/gtest.h>

#include <string>

#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"
#include "support/closest_pair.h"
#include "support/crossings.h"
#include "support/layers.h"

namespace weft::test {
namespace {

using namespace testing_support;

class LongSelfCollision : public GpuTest, public testing::WithParamInterface<const char*> {};

// docs/physics.md "Self-collision": at rest, that is after 5 s on the sphere, no pair of scene 5 at 64² is
// nearer than 80 % of min(thickness, its distance on the flat cloth).
TEST_P(LongSelfCollision, leaves_no_pair_of_scene_5_nearer_than_80_percent) {
  const std::string thickness = GetParam();
  const Model model =
      scene_model("5", {.set = {"cloth.resolution=64", "self_collision.thickness=" + thickness}});
  const auto gpu = GpuSimulation::create(device(), model, find_solver("leapfrog"), {});
  for (int frame = 0; frame < 300; ++frame) gpu->advance(model.scene.solver.frame_s, gpu->plan().substeps);
  const auto closest = testing_support::closest_pair(model, gpu->read());
  RecordProperty("closest", std::to_string(closest.ratio));
  EXPECT_GE(closest.ratio, 0.8) << closest.a << " and " << closest.b;
  EXPECT_EQ(gpu->self_collision()->pairs_dropped, 0u);
}

/// Crossings of edges and triangles at the ends of 300 frames, counted exactly. Native computes them: to the
/// bit what the reference does, in a fraction of the time.
void expect_no_crossing(const LayeredScene& scene) {
  const auto simulation = make_native_simulation(scene.model, find_solver("leapfrog"), "f32", {});
  simulation->write(scene.start);
  for (int frame = 0; frame < 300; ++frame) {
    simulation->advance(scene.model.scene.solver.frame_s, simulation->plan().substeps);
    ASSERT_EQ(crossing_count(scene.model.grid, simulation->read().position), 0u) << "frame " << frame;
  }
  EXPECT_EQ(simulation->self_collision()->pairs_dropped, 0u);
}

// 5 s each at 64² and 128²; the strips have about as many particles.
class LongCrossings : public testing::TestWithParam<std::uint32_t> {};

TEST_P(LongCrossings, are_none_where_twenty_layers_drop) {
  expect_no_crossing(folded_strip(GetParam() / 64 * 14, 20, 0.3));
}

TEST_P(LongCrossings, are_none_in_a_sheet_folded_flat) {
  expect_no_crossing(folded_sheet(GetParam() + 1, 0.1));
}

TEST_P(LongCrossings, are_none_between_sphere_and_floor) {
  const double deep_m = 0.2 + 0.55 / GetParam();  // room for two layers and a tenth more
  expect_no_crossing(folded_sheet(
      GetParam() + 1, 0.03,
      fmt::format("[[spheres]]\nradius = 0.2\nfriction = 0.3\nkeys = [ "
                  "{{ time = 0, center = [-0.2, 0.4, 0] }}, {{ time = 1, center = [-0.2, {0}, 0] }}, "
                  "{{ time = 3, center = [-0.2, {0}, 0] }}, {{ time = 4, center = [-0.2, 0.6, 0] }} ]\n",
                  deep_m)));
}

TEST_P(LongCrossings, are_none_in_scene_5) {
  const Model model = scene_model(
      "5", {.set = {"cloth.resolution=" + std::to_string(GetParam()), "self_collision.thickness=0.004"}});
  expect_no_crossing({model, start_state(model)});
}

INSTANTIATE_TEST_SUITE_P(Resolution, LongCrossings, testing::Values(64u, 128u));

INSTANTIATE_TEST_SUITE_P(Thickness, LongSelfCollision, testing::Values("0.004", "0.01"));

}  // namespace
}  // namespace weft::test
