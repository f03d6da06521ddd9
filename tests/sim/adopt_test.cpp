// Changing a scene while its cloth runs on the device: what the change itself gives the cloth is no
// divergence.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "gpu_fixture.h"
#include "sim/divergence.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"

namespace weft::test {
namespace {

constexpr double kFrame_s = 0.002;

class AdoptTest : public GpuTest {
 protected:
  /// Lets a hung cloth of 1 MN/m run for a few frames, changes its scene as a slider does, and runs on: on
  /// the device and natively.
  void expect_sound_after(const char* what, const std::function<void(Scene&)>& prepare,
                          const std::function<void(Scene&)>& change) {
    Scene scene;
    scene.cloth.resolution = 12;
    scene.material.membrane_n_m = 1e6;
    scene.pins = {{.at = {0.0, 0.0}}, {.at = {1.0, 0.0}}};
    scene.gravity.emplace();
    prepare(scene);
    const Model before = build_model(scene);
    const Solver& leapfrog = find_solver("leapfrog");
    Scene changed = scene;
    change(changed);
    const Model next = build_model(changed);
    run_through(what, *GpuSimulation::create(device(), before, leapfrog), next);
    run_through(what, *make_native_simulation(before, leapfrog, "f32"), next);
  }

 private:
  template <class AnySimulation>
  void run_through(const char* what, AnySimulation& simulation, const Model& next) {
    const auto run = [&](int frames) {
      const double share = kFrame_s / next.scene.solver.frame_s;
      const auto n = static_cast<std::uint32_t>(std::ceil(share * simulation.plan().substeps));
      for (int f = 0; f < frames; ++f) simulation.advance(kFrame_s, n);
    };
    run(5);
    ASSERT_TRUE(simulation.adopt(next)) << what << ": the plan is to stay";
    run(5);
    const State state = simulation.read();
    const std::optional<Divergence> found = simulation.divergence();
    EXPECT_FALSE(found) << what << ": " << what_happened(found.value_or(Divergence{}), next);
  }
};

TEST_F(AdoptTest, WhatAChangeGivesIsNoDivergence) {
  const auto small_sphere = [](Scene& s) { s.spheres = {{.center_m = {0.0, 0.0, 0.1}, .radius_m = 0.05}}; };
  expect_sound_after("a sphere grows into the cloth", small_sphere,
                     [](Scene& s) { s.spheres[0].radius_m = 0.4; });
  expect_sound_after("a sphere is put into the cloth", small_sphere, [](Scene& s) {
    s.spheres[0].center_m = {0.0, 0.0, 0.0};
    s.spheres[0].radius_m = 0.3;
  });
  expect_sound_after(
      "the floor rises",
      [](Scene& s) {
        s.floor.emplace(FloorSection{-3.0, 0.0});
      },
      [](Scene& s) { s.floor->height_m = 0.2; });
  expect_sound_after(
      "a pin's keys place it elsewhere",
      [](Scene& s) {
        s.pins[0].keys = {{0.0, {0.0, 0.0, 0.0}}};
      },
      [](Scene& s) {
        s.pins[0].keys = {{0.0, {0.0, 2.0, 0.0}}};
      });
}

}  // namespace
}  // namespace weft::test
