// Tethers, tearing and pins that let go on the device: the mirrors' bits. long_torn_gpu_test.cpp has every
// solver and precision.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenes.h"
#include "sim/gpu_simulation.h"
#include "validated_pass.h"

namespace weft::test {
namespace {

class TornGpuTest : public ValidatedPassTest {};

TEST_F(TornGpuTest, pins_that_let_go_equal_their_mirrors) {
  const Model model = full_model(kPinsThatLetGo);
  EXPECT_GT(rows_of(model, "leapfrog", "pin_release"), 0u);
}

TEST_F(TornGpuTest, tethers_equal_their_mirror) {
  Scene scene = full_model("").scene;
  scene.tethers = TethersSection{0.0};
  EXPECT_GT(rows_of(build_model(scene), "xpbd", "xpbd_tethers"), 0u);
}

TEST_F(TornGpuTest, tearing_equals_its_mirrors_and_is_drawn) {
  Scene scene = full_model("").scene;
  scene.tearing = TearingSection{0.04};
  const Model model = build_model(scene);
  EXPECT_GT(rows_of(model, "leapfrog", "integrate_torn"), 0u);
  const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
  EXPECT_NE(simulation->draw_buffers().torn_mesh, VK_NULL_HANDLE);
  EXPECT_EQ(simulation->bytes_allocated(), simulation->bytes_expected());
}

TEST_F(TornGpuTest, air_on_whole_triangles_equals_its_mirror) {
  Scene scene = full_model("").scene;
  scene.tearing = TearingSection{0.04};
  scene.aerodynamics = AerodynamicsSection{};
  EXPECT_GT(rows_of(build_model(scene), "leapfrog", "aerodynamics_torn"), 0u);
}

// A state with its tears goes to the device and back.
TEST_F(TornGpuTest, links_go_with_the_state) {
  Scene scene = full_model("").scene;
  scene.tearing = TearingSection{0.5};
  const Model model = build_model(scene);
  const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
  State state = start_state(model);
  state.broken_links.assign(model.grid.count(), 0);
  state.broken_links[7] = 5u;
  simulation->write(state);
  EXPECT_EQ(simulation->read().broken_links, state.broken_links);
}

// Normals for a picture amid a frame change nothing of what is simulated.
TEST_F(TornGpuTest, NormalsAmidAFrameLeaveTheStateAlone) {
  Scene scene = full_model("").scene;
  scene.tearing = TearingSection{0.02};
  const Model model = build_model(scene);
  const auto end_state = [&](bool draws) {
    const auto simulation =
        GpuSimulation::create(device(), model, find_solver("leapfrog"), {.dispatches_per_submit = 5});
    State torn = start_state(model);
    torn.broken_links.assign(model.grid.count(), 0);
    torn.broken_links[7] = 5u;
    for (std::size_t p = 0; p < torn.velocity.size(); ++p)
      torn.velocity[p] = {0.0, 0.0, p % 3 == 0 ? 2.0 : -1.0};
    simulation->write(torn);
    for (int f = 0; f < 3; ++f) {
      simulation->begin_frame(1.0 / 60.0, simulation->plan().substeps);
      while (simulation->continue_frame())
        if (draws) simulation->refresh_normals();
    }
    return simulation->read();
  };
  const State drawn = end_state(true), plain = end_state(false);
  EXPECT_EQ(drawn.broken_links, plain.broken_links);
  EXPECT_TRUE(drawn.position == plain.position);
  EXPECT_TRUE(drawn.velocity == plain.velocity);
}

}  // namespace
}  // namespace weft::test
