// The acceptance of self-collision at its full size; minutes on a software device, so only in the long run.
#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "support/closest_pair.h"

namespace weft::test {
namespace {

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

INSTANTIATE_TEST_SUITE_P(Thickness, LongSelfCollision, testing::Values("0.004", "0.01"));

}  // namespace
}  // namespace weft::test
