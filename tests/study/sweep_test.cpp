// The sweep on the CPU: what its points say, that it goes on after an interruption, and what is kept of it.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file.h"
#include "study/kept_studies.h"
#include "study/report.h"
#include "study_cloths.h"

namespace weft::study {
namespace {

const Bench kCpu{.device = nullptr, .label = "CPU reference"};

SweepOptions quick_options() {
  SweepOptions options;
  options.time_s = 0.05;
  options.quick = true;
  options.solvers = {"leapfrog", "rk4"};
  options.precisions = {"f32", "f64"};
  return options;
}

/// Counts what is measured, and stops after a number of points.
struct Counter {
  std::size_t measured = 0, stop_after = 1000;
  Watch watch() {
    return {.stop = [this] { return measured > stop_after; },
            .note =
                [this](const std::string& text) {
                  if (text.find(" substeps, ") != std::string::npos) ++measured;
                },
            .progress = {}};
  }
};

std::size_t files_in(const std::filesystem::path& folder) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) count += entry.is_regular_file();
  return count;
}

const Point& find(const Study& study, const Setting& setting) {
  for (const Point& point : study.points)
    if (point.setting == setting) return point;
  throw std::runtime_error("the study has no such point");
}

TEST(Sweep, MeasuresErrorTimeAndTheRest) {
  const ScratchCache cache;
  Counter counter;
  const Scene scene = small_scene();
  const Study study = run_study(kCpu, scene, quick_options(), counter.watch());
  const Model model = build_model(scene);
  const auto counts = substep_counts(model, find_solver("leapfrog"), true);
  ASSERT_EQ(study.points.size(), 16u);  // two solvers, two precisions, four counts
  const Point& coarse = find(study, {"leapfrog", "f64", counts[0]});
  const Point& fine = find(study, {"leapfrog", "f64", 2 * counts[0]});
  EXPECT_GT(coarse.error_m, fine.error_m);
  EXPECT_TRUE(coarse.wall_clock);
  EXPECT_GT(coarse.ms_per_s, 0.0);
  EXPECT_GE(coarse.run_count, 1u);
  // Three frames of n + 1 force evaluations each.
  EXPECT_DOUBLE_EQ(coarse.springs_per_frame, double(counts[0] + 1) * double(model.spring_count));
  EXPECT_LT(find(study, {"rk4", "f64", substep_counts(model, find_solver("rk4"), true)[1]}).error_m,
            fine.error_m);
  EXPECT_TRUE(coarse.equilibrium_distance_m);
  EXPECT_FALSE(coarse.energy_drift);  // not in quick form
}

// Times of another machine's making stand in the same diagram: the study says which, and why.
TEST(Sweep, SaysWhatNativeLeavesToTheReference) {
  const ScratchCache cache;
  Counter counter;
  const Study study = run_study(Bench::without_device(true), small_scene(), quick_options(), counter.watch());
  ASSERT_EQ(study.by_reference.size(), 2u);  // one entry a reason
  EXPECT_EQ(study.by_reference[0].what, "rk4 f32");
  EXPECT_EQ(study.by_reference[1].what, "leapfrog f64, rk4 f64");
  const Study read = study_from_json(to_json(study));
  ASSERT_EQ(read.by_reference.size(), 2u);
  EXPECT_EQ(read.by_reference[1].what, study.by_reference[1].what);
  EXPECT_EQ(read.by_reference[1].reason, study.by_reference[1].reason);
  EXPECT_NE(report_html(study).find("leapfrog f64, rk4 f64: native computes in f32 only"), std::string::npos);
}

TEST(Sweep, KeepsWhatDiverged) {
  const ScratchCache cache;
  Scene scene = small_scene();
  scene.material.membrane_n_m = 2000.0;
  SweepOptions options = quick_options();
  options.time_s = 0.3;
  options.precisions = {"f32"};
  options.solvers = {"leapfrog"};
  Counter counter;
  const Study study = run_study(kCpu, scene, options, counter.watch());
  const auto counts = substep_counts(build_model(scene), find_solver("leapfrog"), true);
  const Point& point = find(study, {"leapfrog", "f32", counts[2]});  // half the automatic count
  EXPECT_TRUE(point.diverged);
  EXPECT_TRUE(std::isinf(point.error_m));
  for (const Point* member : pareto_front(study.points, time_cost)) EXPECT_FALSE(member->diverged);
}

TEST(Sweep, MeasuresTheDriftOfEnergyWhenThereIsTime) {
  const ScratchCache cache;
  SweepOptions options = quick_options();
  options.quick = false;
  options.solvers = {"velocity-verlet"};
  options.precisions = {"f64"};
  Counter counter;
  const Study study = run_study(kCpu, small_scene(), options, counter.watch());
  ASSERT_FALSE(study.points.empty());
  const auto counts = substep_counts(build_model(small_scene()), find_solver("velocity-verlet"), false);
  const Point& coarse = find(study, {"velocity-verlet", "f64", counts[0]});
  const Point& fine = find(study, {"velocity-verlet", "f64", counts[1]});
  ASSERT_TRUE(coarse.energy_drift && fine.energy_drift);
  EXPECT_LT(*coarse.energy_drift, 0.05);
  EXPECT_NEAR(*coarse.energy_drift / *fine.energy_drift, 4.0, 1.0);  // second order
}

TEST(Sweep, GoesOnAfterAnInterruption) {
  const ScratchCache cache;
  SweepOptions options = quick_options();
  options.records = cache.folder() / "points";
  Counter stopped{.stop_after = 5};
  try {
    run_study(kCpu, small_scene(), options, stopped.watch());
    FAIL() << "it was not interrupted";
  } catch (const Error& failure) {
    EXPECT_EQ(failure.code(), Exit::interrupted);
  }
  EXPECT_EQ(files_in(options.records), 5u);
  Counter second;
  const Study study = run_study(kCpu, small_scene(), options, second.watch());
  EXPECT_EQ(second.measured, 11u);
  EXPECT_EQ(study.points.size(), 16u);
  Counter third;
  const Study again = run_study(kCpu, small_scene(), options, third.watch());
  EXPECT_EQ(third.measured, 0u);
  EXPECT_EQ(points_csv(again.points), points_csv(study.points));
}

TEST(Sweep, MeasuresADamagedRecordAnew) {
  const ScratchCache cache;
  SweepOptions options = quick_options();
  options.records = cache.folder() / "points";
  Counter first;
  run_study(kCpu, small_scene(), options, first.watch());
  std::size_t damaged = 0;
  for (const auto& entry : std::filesystem::directory_iterator(options.records))
    if (damaged < 3) write_file(entry.path(), damaged++ == 0 ? "" : "{\"identity\": 7}");
  Counter second;
  EXPECT_EQ(run_study(kCpu, small_scene(), options, second.watch()).points.size(), 16u);
  EXPECT_EQ(second.measured, 3u);
}

TEST(Sweep, SaysWhatTheTimeDidNotAllow) {
  const ScratchCache cache;
  SweepOptions options = quick_options();
  options.seconds = 0.0;
  Counter counter;
  const Study study = run_study(kCpu, small_scene(), options, counter.watch());
  EXPECT_EQ(study.points.size(), 0u);
  ASSERT_FALSE(study.left_out.empty());
  EXPECT_EQ(study.left_out.back().what, "16 of 16 settings");
}

// A quick study promises two minutes: the first point of a solver is not begun either when, at the price of a
// dispatch known from others, it would take too long.
TEST(Sweep, DoesNotBeginASolverThatWouldTakeTooLong) {
  const ScratchCache cache;
  SweepOptions options = quick_options();
  options.records = cache.folder() / "points";
  options.precisions = {"f32"};
  options.solvers = {"leapfrog"};
  Counter first;
  run_study(kCpu, small_scene(), options, first.watch());
  for (const auto& entry : std::filesystem::directory_iterator(options.records)) {
    auto record = nlohmann::ordered_json::parse(read_file(entry.path()));
    record["point"]["ms_per_simulated_s"] = 1e9;  // as on a device a million times slower
    write_file(entry.path(), record.dump());
  }
  options.solvers = {"leapfrog", "rk4"};
  Counter second;
  const Study study = run_study(kCpu, small_scene(), options, second.watch());
  EXPECT_EQ(second.measured, 0u);
  EXPECT_EQ(study.points.size(), 4u);
  ASSERT_FALSE(study.left_out.empty());
  EXPECT_EQ(study.left_out.back().what, "4 of 8 settings");
}

TEST(KeptStudies, AreFoundBySceneDeviceAndTime) {
  const ScratchCache cache;
  Scene scene = small_scene();
  Study study{.title = "small", .device = "a device", .time_s = 0.5, .frame_s = 1.0 / 60.0, .complete = true};
  study.cloths = {Cloth{.nx = 9, .ny = 9}, Cloth{.nx = 17, .ny = 17}};
  Point coarse = point_of(1, 1e-3), fine = point_of(2, 1e-4);
  coarse.nx = coarse.ny = 9;
  fine.nx = fine.ny = 17;
  study.points = {coarse, fine};
  keep_study(scene, study);
  ASSERT_TRUE(kept_study(scene, "a device", 0.5));
  EXPECT_EQ(kept_study(scene, "a device", 0.5)->points.size(), 1u);
  EXPECT_EQ(kept_study(scene, "a device", {})->points[0].error_m, 1e-3);
  EXPECT_FALSE(kept_study(scene, "another device", 0.5));
  EXPECT_FALSE(kept_study(scene, "a device", 1.0));
  scene.cloth.resolution = 17;
  EXPECT_EQ(kept_study(scene, "a device", 0.5)->points[0].error_m, 1e-4);
  scene.material.density_kg_m2 *= 2.0;
  EXPECT_FALSE(kept_study(scene, "a device", 0.5));
}

TEST(KeptStudies, AQuickOneDoesNotReplaceAFullOne) {
  const ScratchCache cache;
  const Scene scene = small_scene();
  Study study{.title = "full", .device = "a device", .time_s = 0.5, .frame_s = 0.01, .complete = true};
  study.cloths = {Cloth{.nx = 9, .ny = 9}};
  keep_study(scene, study);
  study.quick = true;
  study.title = "quick";
  keep_study(scene, study);
  EXPECT_EQ(kept_study(scene, "a device", 0.5)->title, "full");
  for (const auto& entry : std::filesystem::directory_iterator(kept_folder(scene, "a device")))
    write_file(entry.path(), "{");
  EXPECT_FALSE(kept_study(scene, "a device", 0.5));
}

}  // namespace
}  // namespace weft::study
