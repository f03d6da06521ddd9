// The vector kernels end in the bits of the float reference: every scene, every effect, every width that this
// machine has, any number of threads.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "model/measures.h"
#include "native/features.h"
#include "scene/reader.h"
#include "sim/native_simulation.h"
#include "sim/native_validate.h"
#include "solvers/solver.h"

namespace weft {
namespace {

Model model_of(const std::string& scene, std::vector<std::string> set) {
  return build_model(load_scene(find_scene(scene), {std::move(set)}).scene);
}

/// Frames of 30 substeps, the last one cut to 7.
State run(Simulation& simulation, std::uint32_t frames) {
  const double frame_s = 30.0 / 60.0 / std::max(30u, simulation.plan().substeps);
  for (std::uint32_t f = 0; f < frames; ++f) simulation.advance(frame_s, 30);
  simulation.advance(frame_s * 7 / 30, 7);
  return simulation.read();
}

State reference(const Model& model, std::uint32_t frames) {
  return run(*make_cpu_simulation(model, find_solver("leapfrog"), "f32"), frames);
}

State vectorised(const Model& model, std::uint32_t frames, const native::EngineOptions& options) {
  return run(*make_native_simulation(model, find_solver("leapfrog"), "f32", options), frames);
}

/// Names the first particle that differs; −0 and +0 agree.
void expect_same(const State& got, const State& expected) {
  ASSERT_EQ(got.position.size(), expected.position.size());
  for (std::size_t p = 0; p < got.position.size(); ++p) {
    ASSERT_EQ(got.position[p], expected.position[p]) << "position of particle " << p;
    ASSERT_EQ(got.velocity[p], expected.velocity[p]) << "velocity of particle " << p;
  }
}

TEST(NativeBits, SixScenesAtEveryWidthEqualTheReference) {
  for (const char* scene : {"1", "2", "3", "4", "5", "6"}) {
    const Model model = model_of(scene, {"cloth.resolution=37"});
    const State expected = reference(model, 6);
    for (const native::Kernels* kernels : native::kernels_here()) {
      SCOPED_TRACE(fmt::format("scene {}, {}", scene, kernels->name));
      expect_same(vectorised(model, 6, {.threads = 1, .vector = kernels->name}), expected);
    }
  }
}

TEST(NativeBits, AnyNumberOfThreadsEqualsTheReference) {
  const Model model = model_of("5", {"cloth.resolution=61", "spheres.0.center=[0,0.9,0]"});
  const State expected = reference(model, 4);
  for (const std::uint32_t threads : {1u, 2u, 3u, 8u}) {
    SCOPED_TRACE(fmt::format("{} threads", threads));
    expect_same(vectorised(model, 4, {.threads = threads, .vector = {}}), expected);
  }
}

/// Bands of very different heights, down to the fewest rows, as where a core is shared; and small ones that
/// have no rows before those which read what is below.
TEST(NativeBits, BandsOfAnyHeightsEndInTheSameBits) {
  for (const char* scene : {"1", "5"}) {
    const Model model = model_of(scene, {"cloth.resolution=61"});
    const State expected = reference(model, 4);
    for (const std::vector<double>& speeds :
         std::vector<std::vector<double>>{{1, 0.01, 1}, {0.01, 1, 0.02}, {3, 1, 2}}) {
      SCOPED_TRACE(fmt::format("scene {}, speeds {}", scene, speeds));
      expect_same(vectorised(model, 4, {.threads = 3, .vector = {}, .speeds = speeds}), expected);
    }
  }
}

/// Where something is pinned native looks at motion only when the sweep's ways allow somebody to leave the
/// lists' room: the lists are made as often as the reference makes them, and those held back are held back.
TEST(NativeBits, ListsAreMadeInTheSubstepsOfTheReference) {
  const std::vector<std::pair<const char*, std::vector<std::string>>> cases{
      {"1", {"cloth.resolution=33", "self_collision.thickness=0.002"}},
      {"3", {"cloth.resolution=33", "self_collision.thickness=0.02", "wind.velocity=[8,0,12]"}},
      {"6", {"cloth.resolution=33", "self_collision.thickness=0.01", "solver.substeps=60"}}};
  for (const auto& [scene, set] : cases) {
    SCOPED_TRACE(fmt::format("{} {}", scene, fmt::join(set, " ")));
    const Model model = model_of(scene, set);
    const auto right = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
    const State expected = run(*right, 40);
    ASSERT_TRUE(right->self_collision());
    EXPECT_GT(right->self_collision()->lists_built, 0u);
    for (const std::uint32_t threads : {1u, 3u}) {
      const auto got = make_native_simulation(model, find_solver("leapfrog"), "f32",
                                              {.threads = threads, .spread_frames = false});
      expect_same(run(*got, 40), expected);
      EXPECT_EQ(got->self_collision()->lists_built, right->self_collision()->lists_built);
      EXPECT_EQ(got->self_collision()->held_back, right->self_collision()->held_back);
    }
  }
}

/// Every switch on and off: what a variant leaves out must be nothing.
TEST(NativeBits, EveryEffectByItselfEqualsTheReference) {
  const std::vector<std::vector<std::string>> variants{
      {"material.damping=0"},
      {"material.flex=0", "material.bend=0"},
      {"material.flex=0", "material.bend=1e-4"},
      {"material.shear=0"},
      {"material.shear=0", "material.flex=0", "material.bend=0", "material.damping=0"},
      {"air.drag=0.3", "wind.velocity=[2,0,3]", "wind.gust=0.5", "wind.period=0.1"},
      {"air.drag=0.3"},
      {"gravity.acceleration=[0,0,0]"},
      {"floor.height=0.65", "floor.friction=0.4"},
      {"cloth.height=0.13"},
      {"cloth.resolution=16"},
      {"cloth.resolution=2"},
      {"cloth.resolution=3"}};
  for (const auto& set : variants) {
    std::vector<std::string> all{"cloth.resolution=33", "cloth.imperfection=0.02"};
    all.insert(all.end(), set.begin(), set.end());
    SCOPED_TRACE(all.back());
    const Model model = model_of("1", all);
    const State expected = reference(model, 4);
    for (const native::Kernels* kernels : native::kernels_here()) {
      SCOPED_TRACE(kernels->name);
      expect_same(vectorised(model, 4, {.threads = 1, .vector = kernels->name}), expected);
    }
  }
}

/// docs/solvers.md: whatever the solver's passes are, native ends in their bits. The variants cover every
/// kind of spring and triple, damped and not, contact, grids narrower than a vector and bands that reach on.
void expect_solver_same(const std::string& solver, const Model& model) {
  const Solver& passes = find_solver(solver);
  ASSERT_EQ(native_lacks(model, passes, "f32"), "");
  const State expected = run(*make_cpu_simulation(model, passes, "f32"), 1);
  ASSERT_NE(state_hash(expected), state_hash(start_state(model)));
  const auto expect_in = [&](const native::EngineOptions& options) {
    SCOPED_TRACE(fmt::format("{}, {} threads", options.vector, options.threads));
    expect_same(run(*make_native_simulation(model, passes, "f32", options), 1), expected);
  };
  for (const native::Kernels* kernels : native::kernels_here())
    expect_in({.threads = 1, .vector = kernels->name});
  expect_in({.threads = 3, .vector = {}});  // one band has two neighbours
}

TEST(NativeBits, VelocityVerletAndXpbdEqualTheReference) {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
  };
  const std::vector<Case> cases{
      {"1", {"cloth.resolution=37", "material.flex=0.25", "material.bend=1e-4"}},
      {"5", {"cloth.resolution=41", "spheres.0.center=[0,0.9,0]"}},
      {"1", {"cloth.resolution=33", "material.damping=0", "cloth.imperfection=0.02"}},
      {"1", {"cloth.resolution=18", "material.flex=0", "material.bend=1e-4", "material.shear=0"}},
      {"1", {"cloth.resolution=49", "air.drag=0.3", "floor.height=0.65", "floor.friction=0.4"}},
      {"2", {"cloth.resolution=70", "cloth.height=0.3"}},
      {"1", {"cloth.resolution=21", "pins.0.release=0.004"}},  // amid the frame
      {"1", {"cloth.resolution=3"}},
      {"1", {"cloth.resolution=2"}}};
  for (const char* solver : {"velocity-verlet", "xpbd"})
    for (const Case& one : cases) {
      std::vector<std::string> set = one.set;
      set.push_back(fmt::format("solver.name=\"{}\"", solver));
      SCOPED_TRACE(fmt::format("{} in scene {} with {}", solver, one.scene, fmt::join(set, " ")));
      expect_solver_same(solver, model_of(one.scene, set));
    }
}

/// Every effect, from a moment when it acts: the ball tears the cloth, pins have let go, the cloth lies on
/// what it falls on and on itself.
TEST(NativeBits, EveryEffectOfTheExampleScenesEqualsTheReference) {
  struct Case {
    const char* scene;
    double from_s;
    std::vector<std::string> set = {};
  };
  const std::vector<Case> cases{{"boxes", 0.6},
                                {"rail", 0.9},
                                {"released", 1.79},
                                {"ring", 0.7},
                                {"slope", 0.7},
                                {"storm", 0.5},
                                {"tearing", 0.22},
                                {"tethers", 0.5},
                                {"1", 0.5, {"material.strain_limit=0.02", "material.membrane=100"}},
                                {"tethers", 0.5, {"material.strain_limit=0.01"}},
                                {"released", 1.79, {"solver.name=\"xpbd\"", "solver.substeps=20"}},
                                {"released", 1.79, {"solver.name=\"velocity-verlet\""}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(fmt::format("{} {}", one.scene, fmt::join(one.set, " ")));
    std::vector<std::string> set = one.set;
    set.push_back("cloth.resolution=33");
    const Model model = model_of(one.scene, set);
    const Solver& solver = find_solver(model.scene.solver.name);
    ASSERT_EQ(native_lacks(model, solver, "f32"), "");
    const auto frames = [&](Simulation& simulation, int count) {
      const double frame_s = model.scene.solver.frame_s;
      for (int f = 0; f < count; ++f) simulation.advance(frame_s, simulation.plan().substeps);
      return simulation.read();
    };
    const auto before = make_native_simulation(model, solver, "f32", {.threads = 1, .vector = {}});
    const State from = frames(*before, static_cast<int>(one.from_s / model.scene.solver.frame_s));
    const auto reference = make_cpu_simulation(model, solver, "f32");
    reference->write(from);
    const State expected = frames(*reference, 3);
    const auto expect_in = [&](const native::EngineOptions& options) {
      SCOPED_TRACE(fmt::format("{}, {} threads", options.vector, options.threads));
      const auto native = make_native_simulation(model, solver, "f32", options);
      native->write(from);
      const State got = frames(*native, 3);
      expect_same(got, expected);
      EXPECT_EQ(got.broken_links, expected.broken_links);
    };
    for (const native::Kernels* kernels : native::kernels_here())
      expect_in({.threads = 1, .vector = kernels->name});
    expect_in({.threads = 3, .vector = {}});
    if (model.scene.tearing) {
      EXPECT_NE(expected.broken_links, from.broken_links) << "nothing tore";
    }
  }
}

/// From the start of scenes in which the limit, or the first break, comes into play after some time: native
/// looks at links only where the sweep's ways allow them to be there, and must not come too late.
TEST(NativeBits, LimitAndTearingBeginInTheSubstepOfTheReference) {
  struct Case {
    const char* scene;
    std::vector<std::string> set;
    int frames;
  };
  const std::vector<Case> cases{
      {"tearing", {"cloth.resolution=33"}, 45},
      {"1", {"cloth.resolution=33", "material.strain_limit=0.01", "material.membrane=100"}, 10},
      {"1", {"cloth.resolution=33", "material.strain_limit=0.3", "material.membrane=2"}, 10}};
  for (const Case& one : cases) {
    SCOPED_TRACE(fmt::format("{} {}", one.scene, fmt::join(one.set, " ")));
    const Model model = model_of(one.scene, one.set);
    const State expected = reference(model, one.frames);
    std::vector<std::string> unlimited = one.set;
    unlimited.push_back(model.scene.tearing ? "tearing.strain=10" : "material.strain_limit=0");
    EXPECT_NE(state_hash(reference(model_of(one.scene, unlimited), one.frames)), state_hash(expected))
        << "nothing came near its limit";
    for (const std::uint32_t threads : {1u, 3u})
      expect_same(vectorised(model, one.frames, {.threads = threads, .vector = {}}), expected);
  }
}

/// A scrap of cloth, torn off around the particle in the middle, which is as far away as `far_m`.
State with_scrap_at(const Model& model, double far_m) {
  const Grid& grid = model.grid;
  State state = start_state(model);
  state.broken_links.assign(grid.count(), 0);
  for (std::uint32_t j = grid.ny / 2 - 2; j <= grid.ny / 2 + 2; ++j)
    for (std::uint32_t i = grid.nx / 2 - 2; i <= grid.nx / 2 + 2; ++i)
      state.broken_links[grid.index(i, j)] = 15;
  const std::uint32_t middle = grid.index(grid.nx / 2, grid.ny / 2);
  state.position[middle] = {-far_m, 0.0, 0.0};
  state.velocity[middle] = {0.0, 0.1, 0.0};
  return state;
}

/// docs/float-form.md "Divergence": up to 2^63 m a broken link has the bits of one that does not exist,
/// though native computes it with coefficients of 0; from 2^64 on both say that the state is unsound.
TEST(NativeBits, ATornScrapFarAwayIsAsInTheReferenceOrUnsoundInBoth) {
  const Model model = model_of("tearing", {"cloth.resolution=21"});
  for (const native::Kernels* kernels : native::kernels_here())
    for (const double far_m : {1e3, 1e12, 9.2e18, 1e30, 3e38}) {
      SCOPED_TRACE(fmt::format("{}, {} m", kernels->name, far_m));
      const State from = with_scrap_at(model, far_m);
      const auto native_run = make_native_simulation(model, find_solver("leapfrog"), "f32",
                                                     {.threads = 1, .vector = kernels->name});
      const auto reference_run = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
      native_run->write(from);
      reference_run->write(from);
      const bool is_sound = far_m < 0x1p63;
      EXPECT_EQ(!native_run->divergence(), is_sound);
      EXPECT_EQ(!reference_run->divergence(), is_sound);
      const State got = run(*native_run, 3), expected = run(*reference_run, 3);
      EXPECT_EQ(!native_run->divergence(), is_sound);
      EXPECT_EQ(!reference_run->divergence(), is_sound);
      if (is_sound) expect_same(got, expected);
    }
}

/// Spheres that hit from the side at 20 m/s, faster than a cell a substep: the swept branch too.
TEST(NativeBits, FastSpheresEqualTheReference) {
  const Model model = model_of("5", {"cloth.resolution=41", "spheres.0.center=[0,0.5,0]",
                                     "spheres.0.velocity=[3,20,1]", "spheres.0.radius=0.2"});
  const State expected = reference(model, 12);
  const State start = start_state(model);
  double moved_m = 0;
  for (std::size_t p = 0; p < start.position.size(); ++p)
    moved_m = std::max(moved_m, expected.position[p].y - start.position[p].y);
  ASSERT_GT(moved_m, 0.02) << "the sphere never reached the cloth";
  for (const native::Kernels* kernels : native::kernels_here()) {
    SCOPED_TRACE(kernels->name);
    expect_same(vectorised(model, 12, {.threads = 1, .vector = kernels->name}), expected);
  }
}

/// Every probe state of `validate`, among them one in contact with everything and one torn; positions,
/// velocities, normals.
TEST(NativeBits, ValidateFindsNoDifference) {
  for (const char* scene : {"1", "5", "tearing"}) {
    const Model model = model_of(scene, {"cloth.resolution=17"});
    const ValidationReport report = validate_native(model, find_solver("leapfrog"), {.lockstep_substeps = 8});
    // states × kernels × {1, 3 threads} × {position, velocity, normal}
    const std::size_t states =
        3 + (!model.scene.spheres.empty() || model.scene.floor) + model.scene.tearing.has_value();
    EXPECT_EQ(report.rows.size(), states * native::kernels_here().size() * 2 * 3);
    for (const ValidationRow& row : report.rows)
      EXPECT_TRUE(row.ok) << row.check << ", " << row.state << ", " << row.buffer << ": " << row.max_abs;
  }
}

TEST(NativeChoice, WhatNativeLacksRunsOnTheReferenceAndSaysSo) {
  const Model model = model_of("1", {"cloth.resolution=9"});
  EXPECT_EQ(native_lacks(model, find_solver("leapfrog"), "f32"), "");
  EXPECT_NE(native_lacks(model, find_solver("leapfrog"), "f64"), "");
  EXPECT_NE(native_lacks(model, find_solver("rk4"), "f32"), "");
  const auto simulation = make_native_simulation(model, find_solver("rk4"), "f32");
  EXPECT_EQ(simulation->device_name(), "CPU reference (f32)");
}

TEST(NativeChoice, AnUnknownWidthIsRefusedWithThoseThereAre) {
  const Model model = model_of("1", {"cloth.resolution=9"});
  try {
    make_native_simulation(model, find_solver("leapfrog"), "f32", {.threads = 1, .vector = "AVX-4096"});
    FAIL() << "AVX-4096 was accepted";
  } catch (const Error& refusal) {
    EXPECT_EQ(refusal.code(), Exit::usage);
    EXPECT_NE(std::string(refusal.what()).find("plain"), std::string::npos);
  }
}

}  // namespace
}  // namespace weft
