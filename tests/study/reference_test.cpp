// The reference: that it converges and says how far, what its floors are, and that its cache is never
// trusted when damaged.
#include "study/reference.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "model/measures.h"
#include "study/identity.h"
#include "study_cloths.h"

namespace weft::study {
namespace {

constexpr double kTime_s = 0.1;
const Stop kGoOn = [] { return false; };
const auto kQuiet = [](const std::string&) {};

TEST(Reference, AgreesWithAFinerRunAsFarAsItSays) {
  const Model model = build_model(small_scene());
  const Reference reference = make_reference(model, kTime_s, {}, kGoOn, kQuiet);
  EXPECT_EQ(reference.ending, Ending::agreed);
  EXPECT_LE(reference.agreement_m, 1e-9);
  EXPECT_EQ(reference.frames.size(), 7u);  // the start and six frames of 1/60 s
  EXPECT_NEAR(reference.frames.back().time_s, kTime_s, 1e-12);
  const Trajectory finer = run_on_cpu(model, {"rk4", "f64", 4 * reference.substeps}, kTime_s, kGoOn);
  EXPECT_LE(trajectory_distance(reference.frames, finer), reference.agreement_m);
}

TEST(Reference, AnotherSolverConvergesToIt) {
  // leapfrog in double is of second order: twice the substeps, a quarter of the distance.
  Scene scene = small_scene();
  scene.material.damping_s = 0.0;
  const Model model = build_model(scene);
  const Reference reference = make_reference(model, kTime_s, {}, kGoOn, kQuiet);
  const auto error_m = [&](std::uint32_t n) {
    return trajectory_distance(run_on_cpu(model, {"leapfrog", "f64", n}, kTime_s, kGoOn), reference.frames);
  };
  EXPECT_NEAR(error_m(80) / error_m(160), 4.0, 0.2);
}

TEST(Reference, IsFinerThanTheFinestRk4ThatItJudges) {
  const Model model = build_model(small_scene());
  ReferenceOptions fine;
  fine.levels_min = 5;
  const Reference reference = make_reference(model, kTime_s, fine, kGoOn, kQuiet);
  EXPECT_EQ(reference.ending, Ending::agreed);
  // A quarter of its substeps is what a study shows at most; fourth order makes that 16 times less exact.
  const Trajectory shown = run_on_cpu(model, {"rk4", "f64", reference.substeps / 4}, kTime_s, kGoOn);
  EXPECT_LE(reference.agreement_m, 0.1 * trajectory_distance(shown, reference.frames));
}

TEST(Reference, WhatRk4CannotRunIsRefinedWithASolverThatCan) {
  EXPECT_EQ(reference_solver(build_model(small_scene())).name, "rk4");
  Scene limited = small_scene();
  limited.material.strain_limit = 1e-4;  // its own weight stretches it further: the limit acts
  const Model model = build_model(limited);
  ReferenceOptions few;
  few.levels_max = 5;
  few.discretisation = false;
  const Reference reference = make_reference(model, kTime_s, few, kGoOn, kQuiet);
  EXPECT_EQ(reference.solver, "leapfrog");
  // A projection once a substep converges in first order: five levels leave a sixteenth of the coarsest's
  // error.
  const Trajectory coarse = run_on_cpu(model, {"leapfrog", "f64", reference.substeps >> 4}, kTime_s, kGoOn);
  EXPECT_LE(reference.agreement_m, 0.15 * trajectory_distance(coarse, reference.frames));
  Scene touching = small_scene();
  touching.self_collision = SelfCollisionSection{};
  EXPECT_EQ(reference_solver(build_model(touching)).name, "leapfrog");
}

TEST(Reference, RunningOutOfTimeIsSaid) {
  const Model model = build_model(small_scene());
  ReferenceOptions hurried;
  hurried.tolerance_m = 1e-30;
  hurried.seconds = 0.0;
  const Reference reference = make_reference(model, kTime_s, hurried, kGoOn, kQuiet);
  EXPECT_NE(reference.ending, Ending::agreed);
  EXPECT_GT(reference.agreement_m, 0.0);
  EXPECT_LT(reference.discretisation_m, 0.0);  // not measured
}

TEST(Reference, TwinsStartAtTheirDistance) {
  const Model model = build_model(small_scene());
  const State start = start_state(model), twin = perturbed_start(model, kTwinStart_m);
  EXPECT_NEAR(rms_distance(start, twin), kTwinStart_m, 1e-6 * kTwinStart_m);
  for (std::size_t p = 0; p < start.position.size(); ++p) {
    if (model.relative_inverse_mass[p] == 0.0) {
      EXPECT_EQ(start.position[p], twin.position[p]);
    }
  }
}

TEST(Reference, InterruptionEndsIt) {
  const Model model = build_model(small_scene());
  try {
    make_reference(
        model, kTime_s, {}, [] { return true; }, kQuiet);
    FAIL() << "it went on";
  } catch (const Error& failure) {
    EXPECT_EQ(failure.code(), Exit::interrupted);
  }
}

Reference tiny_reference() {
  Reference reference{.substeps = 7, .agreement_m = 1e-9, .twin_m = 2e-7, .fine_nx = 3, .allowed_s = 600.0};
  State state;
  state.position = {{1, 2, 3}, {4, 5, 6}};
  state.velocity = {{-1, 0, 1}, {0.1, 0.2, 0.3}};
  state.time_s = 0.25;
  reference.frames = {state, state};
  return reference;
}

TEST(ReferenceFile, ReturnsEveryBit) {
  const Reference written = tiny_reference();
  const auto read = from_bytes(to_bytes(written, "cloth"), "cloth");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->substeps, written.substeps);
  EXPECT_EQ(read->agreement_m, written.agreement_m);
  EXPECT_EQ(read->twin_m, written.twin_m);
  ASSERT_EQ(read->frames.size(), 2u);
  EXPECT_EQ(read->frames[1].position, written.frames[1].position);
  EXPECT_EQ(read->frames[1].velocity, written.frames[1].velocity);
  EXPECT_EQ(read->frames[1].time_s, 0.25);
}

TEST(ReferenceFile, DamageAnywhereIsNoticed) {
  const std::string bytes = to_bytes(tiny_reference(), "cloth");
  EXPECT_FALSE(from_bytes(bytes, "another cloth"));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_FALSE(from_bytes(damaged, "cloth")) << "byte " << at;
    EXPECT_FALSE(from_bytes(std::string_view(bytes).substr(0, at), "cloth")) << "cut at " << at;
  }
}

TEST(ReferenceFile, IsUsedAgainAndReplacedWhenDamaged) {
  const ScratchCache cache;
  const Model model = build_model(small_scene());
  int computed = 0;
  const auto count = [&](const std::string&) { ++computed; };
  const Reference first = find_reference(model, kTime_s, {}, kGoOn, count);
  EXPECT_GT(computed, 0);
  computed = 0;
  EXPECT_EQ(find_reference(model, kTime_s, {}, kGoOn, count).frames.back().position,
            first.frames.back().position);
  EXPECT_EQ(computed, 0);
  const std::filesystem::path file = reference_file(model, kTime_s);
  write_file(file, read_file(file).substr(0, 1000));
  EXPECT_EQ(find_reference(model, kTime_s, {}, kGoOn, count).agreement_m, first.agreement_m);
  EXPECT_GT(computed, 0);
  EXPECT_TRUE(kept_reference(model, kTime_s));
}

TEST(Identity, FollowsWhatMovesTheClothAndNothingElse) {
  const Scene scene = small_scene();
  Scene same = scene;
  same.title = "another title";
  same.solver.name = "rk4";
  same.solver.substeps = 99;
  same.expect.emplace().max_stretch = 0.5;
  EXPECT_EQ(canonical_scene(scene), canonical_scene(same));
  Scene other = scene;
  other.material.density_kg_m2 = std::nextafter(scene.material.density_kg_m2, 1.0);
  EXPECT_NE(canonical_scene(scene), canonical_scene(other));
  other = scene;
  other.spheres.emplace_back();
  EXPECT_NE(canonical_scene(scene), canonical_scene(other));
  other = scene;
  other.solver.frame_s *= 2.0;
  EXPECT_NE(canonical_scene(scene), canonical_scene(other));
}

}  // namespace
}  // namespace weft::study
