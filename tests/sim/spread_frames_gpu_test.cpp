// Frames that the device computes without self-collision's passes, because its looks prove that they would
// find nothing, end in the reference's bits; so do those that it takes back.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu_fixture.h"
#include "plan/spread_frame.h"
#include "scene/reader.h"
#include "sim/cpu_simulation.h"
#include "sim/gpu_simulation.h"
#include "sim/simulation.h"
#include "solvers/solver.h"

namespace weft {
namespace {

constexpr double kFrame_s = 1.0 / 60.0;

class SpreadFramesOnGpu : public test::GpuTest {
 protected:
  static Model scene_of(const std::string& scene, std::vector<std::string> set) {
    return build_model(load_scene(find_scene(scene), {std::move(set)}).scene);
  }
  static Model flag() { return scene_of("1", {"cloth.resolution=24", "self_collision.thickness=0.01"}); }
  static std::unique_ptr<GpuSimulation> on_device(const Model& model, const std::string& kernel = "texel",
                                                  std::uint32_t dispatches = 0) {
    return GpuSimulation::create(device(), model, find_solver("leapfrog"),
                                 {.dispatches_per_submit = dispatches, .kernel = kernel});
  }
  static std::unique_ptr<Simulation> reference(const Model& model) {
    return make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  }
  /// Whether the device must round as IEEE 754 says.
  static bool is_exact() { return device().info().software; }

  static void expect_same(Simulation& got, Simulation& expected) {
    const State a = got.read(), b = expected.read();
    ASSERT_EQ(a.position.size(), b.position.size());
    EXPECT_EQ(a.time_s, b.time_s);
    for (std::size_t p = 0; is_exact() && p < a.position.size(); ++p) {
      ASSERT_EQ(a.position[p], b.position[p]) << "position of particle " << p;
      ASSERT_EQ(a.velocity[p], b.velocity[p]) << "velocity of particle " << p;
    }
  }
  static void advance(Simulation& simulation, int frames) {
    for (int f = 0; f < frames; ++f) simulation.advance(kFrame_s, simulation.plan().substeps);
  }
};

// A flag that stays spread, by every kind of kernel; cloth that falls on a sphere and folds; one that a wind
// crumples, so that frames are taken back.
TEST_F(SpreadFramesOnGpu, EndInTheReferencesBits) {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
    std::vector<const char*> kernels;
    int frames, spread_least, spread_most;
  };
  const std::vector<Case> cases{
      {"1", {"cloth.resolution=24", "self_collision.thickness=0.01"}, {"direct", "texel", "strip"}, 8, 6, 8},
      {"5", {"cloth.resolution=17", "self_collision.thickness=0.01"}, {"texel"}, 30, 3, 25},
      {"3",
       {"cloth.resolution=17", "self_collision.thickness=0.02", "wind.velocity=[8,0,12]"},
       {"texel"},
       30,
       1,
       29}};
  for (const Case& one : cases) {
    const Model model = scene_of(one.scene, one.set);
    const auto right = reference(model);
    advance(*right, one.frames);
    for (const char* kernel : one.kernels) {
      SCOPED_TRACE(fmt::format("scene {}, kernel {}", one.scene, kernel));
      const auto got = on_device(model, kernel);
      advance(*got, one.frames);
      expect_same(*got, *right);
      const auto report = got->self_collision();
      ASSERT_TRUE(report);
      EXPECT_EQ(report->held_back, right->self_collision()->held_back);
      EXPECT_GE(report->spread_frames, static_cast<std::uint32_t>(one.spread_least));
      EXPECT_LE(report->spread_frames, static_cast<std::uint32_t>(one.spread_most));
    }
  }
}

// What it is for: a frame of a cloth that is spread has the dispatches of the scene without the section, and
// those of the looks.
TEST_F(SpreadFramesOnGpu, DispatchWhatTheSceneWithoutTheSectionDoesAndLooks) {
  const auto simulation = on_device(flag());
  const std::uint32_t n = simulation->plan().substeps;
  const Model without = scene_of("1", {"cloth.resolution=24", fmt::format("solver.substeps={}", n)});
  const std::uint64_t plain = compile_plan(without, find_solver("leapfrog")).dispatches();
  advance(*simulation, 3);
  const FrameStats stats = simulation->advance(kFrame_s, n);
  ASSERT_EQ(simulation->self_collision()->spread_frames, 4u);
  EXPECT_GT(stats.dispatches, plain);
  EXPECT_LE(stats.dispatches, plain + n / 4 + 2) << "a look in every fourth substep at most";
  EXPECT_LT(stats.dispatches, simulation->plan().dispatches() / 4);
  EXPECT_EQ(stats.spring_evaluations, (n + 1) * std::uint64_t{simulation->model().spring_count});
}

// In submits of any size, and after frames too short to be worth a look.
TEST_F(SpreadFramesOnGpu, DoNotDependOnSubmits) {
  const Model model = flag();
  const auto right = reference(model);
  const auto run = [&](Simulation& simulation) {
    const std::uint32_t n = simulation.plan().substeps;
    simulation.advance(kFrame_s, n);
    simulation.advance(kFrame_s * 3 / n, 3);
    simulation.advance(kFrame_s, n);
  };
  run(*right);
  for (const std::uint32_t dispatches : {1u, 7u, 4096u}) {
    SCOPED_TRACE(dispatches);
    const auto got = on_device(model, "texel", dispatches);
    run(*got);
    expect_same(*got, *right);
  }
}

// The state may be asked for when nothing is proven yet of a frame.
TEST_F(SpreadFramesOnGpu, LetTheStateBeReadAmidOne) {
  const Model model = flag();
  const auto right = reference(model);
  const auto got = on_device(model, "texel", 16);
  advance(*right, 4);
  for (int f = 0; f < 4; ++f) {
    got->begin_frame(kFrame_s, got->plan().substeps);
    for (int part = 0; got->continue_frame(); ++part)
      if (part == 2 && f % 2 == 1) {
        EXPECT_GT(got->read().time_s, f * kFrame_s);
      }
  }
  expect_same(*got, *right);
}

// Between frames: a state from outside, the same cloth by another model, a pin that is dragged.
TEST_F(SpreadFramesOnGpu, GoOnFromStatesThatOthersWrite) {
  const Model model = flag();
  const auto right = reference(model);
  const auto got = on_device(model);
  advance(*right, 2);
  advance(*got, 2);
  State turned = right->read();
  for (auto& v : turned.velocity) v = -v;
  right->write(turned);
  got->write(turned);
  advance(*right, 2);
  advance(*got, 2);
  expect_same(*got, *right);

  const Model windless =
      scene_of("1", {"cloth.resolution=24", "self_collision.thickness=0.012", "wind.velocity=[0.5,0,0.1]"});
  if (got->adopt(windless)) {
    const auto other = reference(windless);
    other->write(got->read());
    advance(*other, 2);
    advance(*got, 2);
    expect_same(*got, *other);
  }
}

// A pin that is dragged between two frames, or amid one that is not proven yet.
TEST_F(SpreadFramesOnGpu, GoOnFromPinsThatAreDragged) {
  const Model model = flag();
  const auto right = make_host_reference(model, find_solver("leapfrog"), "f32");
  const auto got = on_device(model, "texel", 16);
  const auto drag = [](auto& simulation, int f) {
    const glm::vec3 to(-0.5 + 0.01 * f, 1.3, 0.02 * f);
    simulation.place(std::vector{PlacedParticle{0, to, glm::vec3(0.0f)}});
  };
  for (int f = 0; f < 5; ++f) {
    if (f % 2 == 1) drag(*right, f);
    advance(*right, 1);
    got->begin_frame(kFrame_s, got->plan().substeps);
    if (f % 2 == 1) drag(*got, f);  // nothing of it is submitted yet
    while (got->continue_frame()) {
    }
  }
  expect_same(*got, *right);
}

// Whatever cannot be proven is computed with all passes, in the bits of a run that never tried: cloth that is
// pressed together until it touches.
TEST_F(SpreadFramesOnGpu, AreTakenBackWhereTheClothFolds) {
  const Model model = scene_of("1", {"cloth.resolution=17", "self_collision.thickness=0.03"});
  const auto right = reference(model);
  const auto got = on_device(model);
  State pressed = right->read();
  for (std::uint32_t p = 0; p < pressed.position.size(); ++p) {
    const double across = static_cast<double>(p % model.grid.nx) / (model.grid.nx - 1) - 0.5;
    if (model.relative_inverse_mass[p] != 0.0)
      pressed.velocity[p] = glm::dvec3(-12.0 * across, 0.0, p % 2 * 0.1);
  }
  right->write(pressed);
  got->write(pressed);
  advance(*right, 8);
  advance(*got, 8);
  expect_same(*got, *right);
  EXPECT_LT(got->self_collision()->spread_frames, 8u);
}

/// Cloth at rest, of wide cells, and a sphere that reaches it from below in its twelfth frame, 0.195 s.
Model struck() {
  std::string pins;
  for (const char* corner : {"[0, 0]", "[1, 0]", "[0, 1]", "[1, 1]"})
    pins += fmt::format("[[pins]]\nat = {}\n", corner);
  return build_model(
      parse_scene(
          "[cloth]\nresolution = 9\nimperfection = 0\norientation = \"horizontal\"\ncenter = [0, 0, 0]\n" +
              pins +
              "[self_collision]\nthickness = 0.01\n[[spheres]]\nradius = 0.3\nkeys = [{time = 0, center = "
              "[0, -0.3245, 0]}, {time = 1, center = [0, -0.2245, 0]}]\n",
          "struck.toml")
          .scene);
}

// A blow between two looks: neither of them sees cloth that is not spread, but `integrate` tells of it.
TEST_F(SpreadFramesOnGpu, AreTakenBackAfterABlow) {
  const Model model = struck();
  const auto got = on_device(model);
  advance(*got, 11);
  EXPECT_EQ(got->self_collision()->spread_frames, 11u);
  advance(*got, 1);
  EXPECT_EQ(got->self_collision()->spread_frames, 11u);
}

// What is put back is the frame's start, not a state before somebody moved a pin.
TEST_F(SpreadFramesOnGpu, KeepWhatIsPlacedWhereTheyCannotBeProven) {
  const Model model = struck();
  const auto right = make_host_reference(model, find_solver("leapfrog"), "f32");
  const auto got = on_device(model);
  advance(*right, 11);
  advance(*got, 11);
  const std::vector placed{PlacedParticle{
      0, glm::vec3(right->read().position[0]) + glm::vec3(0.01f, 0.0f, 0.0f), glm::vec3(0.0f)}};
  right->place(placed);
  got->place(placed);
  advance(*right, 1);
  advance(*got, 1);
  expect_same(*got, *right);
}

}  // namespace
}  // namespace weft
