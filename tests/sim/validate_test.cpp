// validate: it passes where the device is right, and fails when any one constant of a pass is falsified.
#include "sim/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/error.h"
#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/bench.h"
#include "sim/compare.h"
#include "sim/submit_pacer.h"

namespace weft::test {
namespace {

class ValidateTest : public GpuTest {};

TEST_F(ValidateTest, passes_every_scene_and_covers_every_step) {
  for (const AssetInfo& asset : list_scenes()) {
    const Model model = build_model(load_scene(asset.file).scene);
    const ValidationReport report =
        validate(device(), model, find_solver("leapfrog"), {.lockstep_frames = 1});
    std::set<std::string> checks;
    for (const ValidationRow& row : report.rows) {
      checks.insert(row.check);
      EXPECT_TRUE(row.ok) << asset.name << ": " << row.check << ", " << row.state << ", " << row.buffer
                          << ": " << row.verdict << ", max " << row.max_abs << ", " << row.max_ulp << " ulp";
    }
    EXPECT_TRUE(report.ok());
    EXPECT_EQ(checks, (std::set<std::string>{"integrate", "integrate (frame end)", "normals (frame end)",
                                             "lockstep"}));
  }
}

TEST_F(ValidateTest, sees_every_constant_that_is_falsified) {
  const Model model = full_model();
  for (const char* constant :
       {"shear", "flex", "bending", "damping", "air", "wind", "gravity", "floor", "spheres", "pins"}) {
    const std::string name = fmt::format("integrate.{}", constant);
    const ValidationReport report = validate(device(), model, find_solver("leapfrog"),
                                             {.perturb = name, .lockstep_substeps = 0, .lockstep_frames = 0});
    EXPECT_EQ(report.perturbed, name);
    EXPECT_FALSE(report.ok()) << name;
  }
}

TEST_F(ValidateTest, sees_a_falsified_constant_in_lockstep_and_from_the_environment) {
  const ScopedEnvironment perturb("WEFT_PERTURB", "integrate.shear");
  const ValidationReport report = validate(device(), full_model(), find_solver("leapfrog"));
  bool lockstep_failed = false;
  for (const ValidationRow& row : report.rows) lockstep_failed |= row.check == "lockstep" && !row.ok;
  EXPECT_TRUE(lockstep_failed);
}

TEST_F(ValidateTest, leaves_alone_what_a_scene_does_not_have_and_refuses_what_no_pass_has) {
  const Model bare = build_model(parse_scene("[cloth]\nresolution = 8\n", "bare.toml").scene);
  const auto falsified = [&](const char* name) {
    return validate(device(), bare, find_solver("leapfrog"),
                    {.perturb = name, .lockstep_substeps = 1, .lockstep_frames = 0});
  };
  EXPECT_TRUE(falsified("integrate.wind").ok());
  EXPECT_EQ(falsified("integrate.wind").perturbed, "");
  for (const char* unknown : {"integrate.glue", "integrate", "normals.shear", "x.y.z"})
    EXPECT_THROW(falsified(unknown), Error) << unknown;
}

TEST(Compare, counts_floats_between_and_takes_both_zeros_for_one) {
  EXPECT_EQ(ulp_between(1.0f, 1.0f), 0u);
  EXPECT_EQ(ulp_between(0.0f, -0.0f), 0u);
  EXPECT_EQ(ulp_between(1.0f, std::nextafter(1.0f, 2.0f)), 1u);
  EXPECT_EQ(ulp_between(-1.0f, std::nextafter(-1.0f, 0.0f)), 1u);
  const float least = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(ulp_between(-least, least), 2u);
}

TEST(Compare, finds_the_largest_difference_and_anything_not_finite) {
  std::vector<glm::vec4> a(3, glm::vec4(1.0f)), b = a;
  b[1].z = 1.5f;
  EXPECT_DOUBLE_EQ(difference(a, b).max_abs, 0.5);
  EXPECT_DOUBLE_EQ(difference(a, b).rms, std::sqrt(0.25 / 12));
  EXPECT_TRUE(difference(a, b).finite);
  b[2].w = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(difference(a, b).finite);
  EXPECT_FALSE(difference(b, b).finite);
}

// A submit may take 50 ms; the pacer aims at 40 and answers with powers of two.
TEST(SubmitPacer, keeps_a_submit_under_50_ms) {
  for (const double dispatch_ms : {0.02, 0.5, 3.0, 13.0, 39.0, 200.0}) {
    SubmitPacer pacer;
    pacer.measured(2, 90.0);  // the first compiles
    EXPECT_TRUE(pacer.learning());
    for (int frame = 0; frame < 5; ++frame) pacer.measured(pacer.chunk(), pacer.chunk() * dispatch_ms);
    EXPECT_FALSE(pacer.learning());
    EXPECT_TRUE(pacer.chunk() == 1 || pacer.chunk() * dispatch_ms < 50.0) << dispatch_ms;
    if (dispatch_ms < 30) {
      EXPECT_GT(pacer.chunk() * dispatch_ms, 10.0) << dispatch_ms;
    }
  }
}

class BenchTest : public GpuTest {};

TEST_F(BenchTest, times_every_pass_with_and_without_damping) {
  if (!device().info().timestamps) GTEST_SKIP() << "no timestamps";
  const Scene scene = load_scene(find_scene("1")).scene;
  const BenchReport report =
      bench(device(), scene, {.resolutions = {32}, .repetitions = 3, .repetition_s = 0.005});
  ASSERT_EQ(report.rows.size(), 2u);
  EXPECT_TRUE(report.rows[0].damping);
  EXPECT_FALSE(report.rows[1].damping);
  EXPECT_GT(report.copy.best_gb_s(), 0.0);
  for (const BenchRow& row : report.rows) {
    EXPECT_EQ(row.passes.size(), 2u);  // integrate, normals
    EXPECT_GT(row.ns_per_particle_substep.median, 0.0);
    EXPECT_NEAR(row.copy_share, 64 / row.ns_per_particle_substep.median / report.copy.best_gb_s(), 1e-9);
  }
  const std::string json = to_benchmark_json(report);
  for (const char* key :
       {"\"context\"", "\"benchmarks\"", "\"real_time\"", "\"time_unit\"", "integrate/32x32/damped"})
    EXPECT_NE(json.find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace weft::test
