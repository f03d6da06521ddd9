// The window's cloth on native: a thread of its own, and what it lacks elsewhere.
#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu_fixture.h"
#include "model/measures.h"
#include "sim/host_drawn.h"
#include "sim/native_simulation.h"
#include "viewer/running_scene.h"

namespace weft {
namespace {

class NativeSceneTest : public test::GpuTest {
 protected:
  static void frames(RunningScene& running, int count) {
    running.set_paused(true);
    for (int k = 0; k < count; ++k) {
      running.step();
      do running.advance(0.0, 0.05);
      while (running.mid_frame());
    }
  }
};

// docs/viewer.md: native where it can, the reference for what it lacks; the state goes along, and the window
// says which it is.
TEST_F(NativeSceneTest, WhatNativeLacksTheReferenceComputesAndSaysSo) {
  RunningScene running(device(), {{"cloth.resolution=24"}}, "1", {}, ComputeOn::native);
  EXPECT_EQ(running.on_gpu(), nullptr);
  EXPECT_EQ(running.why_not_native(), "");
  EXPECT_EQ(running.computed_by().substr(0, 6), "native");
  frames(running, 2);
  const State before = running.simulation().read();
  Scene other = running.scene();
  other.solver.name = "rk4";
  running.apply(other);
  EXPECT_NE(running.why_not_native(), "");
  EXPECT_EQ(running.computed_by(), "CPU reference (f32)");
  EXPECT_EQ(state_hash(running.simulation().read()), state_hash(before));
  frames(running, 1);
  EXPECT_TRUE(all_finite(running.simulation().read()));
  other.solver.name = "leapfrog";
  running.apply(other);
  EXPECT_EQ(running.on_gpu(), nullptr);
  EXPECT_EQ(running.why_not_native(), "");
  EXPECT_THROW(running.set_kernel("texel"), Error) << "native has no kernels to choose from";
}

// A thread computes while the window looks: whatever is asked in the middle of a frame changes no bit.
TEST_F(NativeSceneTest, LookingAtAFrameUnderWayOnNativeChangesNothing) {
  const Model model = build_model(load_scene(find_scene("1"), {{"cloth.resolution=200"}}).scene);
  const Solver& solver = find_solver("leapfrog");
  const auto whole = make_native_simulation(model, solver, "f32");
  const auto drawn = draw_host_simulation(device(), make_native_simulation(model, solver, "f32"));
  constexpr std::uint32_t kSubsteps = 200;
  const double frame_s = model.scene.solver.frame_s * kSubsteps / whole->plan().substeps;
  for (int frame = 0; frame < 3; ++frame) {
    whole->advance(frame_s, kSubsteps);
    drawn->begin_frame(frame_s, kSubsteps);
    double time_s = drawn->time_s();
    do {
      drawn->refresh_normals();
      EXPECT_NE(drawn->draw_buffers().position, VK_NULL_HANDLE);
      EXPECT_GE(drawn->time_s(), time_s);
      time_s = drawn->time_s();
      if (frame == 1) {
        EXPECT_TRUE(all_finite(drawn->read()));
      }
    } while (drawn->continue_frame());
  }
  EXPECT_EQ(state_hash(whole->read()), state_hash(drawn->read()));
  EXPECT_EQ(whole->time_s(), drawn->time_s());
}

}  // namespace
}  // namespace weft
