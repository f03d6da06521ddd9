// validate: it passes where the device is right, and fails when any one constant of a pass is falsified.
#include "sim/validate.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "core/error.h"
#include "core/file.h"
#include "gpu/shader.h"
#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/bench.h"
#include "sim/compare.h"
#include "sim/submit_pacer.h"

namespace weft::test {
namespace {

class ValidateTest : public GpuTest {};

TEST_F(ValidateTest, passes_every_scene_and_covers_every_step) {
  for (const AssetInfo& asset : numbered_scenes()) {
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
    std::set<std::string> expected{"normals (frame end)", "watch (frame end)", "judge (frame end)",
                                   "keep_sound (frame end)", "integrate, kernel bands, 4 substeps"};
    for (const char* kernel : {"", ", kernel texel", ", kernel strip", ", kernel steal", ", kernel bands"})
      for (const char* check : {"integrate", "integrate (frame end)", "lockstep"})
        expected.insert(std::string(check) + kernel);
    EXPECT_EQ(checks, expected);
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
  std::set<std::string> blind;  // what compares with the mirror's shear and does not see that it is off
  for (const ValidationRow& row : report.rows) {
    lockstep_failed |= row.check == "lockstep" && !row.ok;
    if (row.buffer == "velocity" || row.buffer == "velocity_next") blind.insert(row.check);
  }
  for (const ValidationRow& row : report.rows)
    if (!row.ok) blind.erase(row.check);
  EXPECT_TRUE(lockstep_failed);
  EXPECT_EQ(blind, std::set<std::string>{}) << "every check, and every kernel's own, must see it";
}

/// What fails when a scene's device is judged by the law for devices that round otherwise.
std::string failures(const ValidationReport& report) {
  std::string text;
  for (const ValidationRow& row : report.rows)
    if (!row.ok)
      text += fmt::format("{}, {}, {}: {}, max {:.3g} of {:.3g}, rms {:.3g}, bias {:.3g}\n", row.check,
                          row.state, row.buffer, row.verdict, row.max_abs, row.tolerance, row.rms, row.bias);
  return text;
}

/// Shaders whose spring roots are off by `ulps` everywhere, all to the same side, as a poor divider's are.
class PoorRoots {
 public:
  explicit PoorRoots(int ulps)
      : folder_(std::filesystem::temp_directory_path() / fmt::format("weft-poor-roots-{}", getpid())) {
    namespace fs = std::filesystem;
    fs::remove_all(folder_);
    fs::copy(WEFT_SOURCE_DIR "/shaders", folder_, fs::copy_options::recursive);
    std::string text = read_file(folder_ / "shared/force.glsl");
    const std::string right = "1.0 / root", wrong = fmt::format("(1.0 / root) * {:.9f}", 1.0 + ulps * 1.2e-7);
    const auto at = text.find(right);
    EXPECT_NE(at, std::string::npos);
    write_file(folder_ / "shared/force.glsl", text.replace(at, right.size(), wrong));
    gpu::set_shader_dir(folder_);
  }
  ~PoorRoots() {
    gpu::set_shader_dir({});
    std::filesystem::remove_all(folder_);
  }
  PoorRoots(const PoorRoots&) = delete;
  PoorRoots& operator=(const PoorRoots&) = delete;

 private:
  std::filesystem::path folder_;
};

// Vulkan lets a root and a division together be some 5 ulp off; 3 must pass, in lockstep, too. It is no empty
// law: the same device is not exact.
TEST_F(ValidateTest, passes_a_device_that_divides_some_ulp_off) {
  const PoorRoots poor(3);
  for (const Model& model : {full_model(), scene_model("1"), scene_model("5", {{"cloth.resolution=40"}})}) {
    const ValidationReport report =
        validate(device(), model, find_solver("leapfrog"),
                 {.lockstep_frames = 1, .every_kernel = false, .assume_inexact = true});
    EXPECT_FALSE(report.exact_required);
    EXPECT_EQ(failures(report), "") << model.scene.title;
    EXPECT_TRUE(std::ranges::any_of(report.rows, [](const auto& row) { return row.max_ulp > 0; }));
  }
}

// A hundredth of any constant must show there too, with good roots and with poor ones.
TEST_F(ValidateTest, sees_every_falsified_constant_on_a_device_that_need_not_be_exact) {
  const Model model = full_model();
  const std::vector<const char*> all{"shear", "flex",    "bending", "damping", "air",
                                     "wind",  "gravity", "floor",   "spheres", "pins"};
  const std::vector<const char*> weakest{"bending"};  // with poor roots each is a new compile
  for (const int ulps : {0, 3}) {
    const PoorRoots poor(ulps);
    for (const char* constant : ulps == 0 ? all : weakest) {
      const ValidationReport report = validate(device(), model, find_solver("leapfrog"),
                                               {.perturb = fmt::format("integrate.{}", constant),
                                                .lockstep_substeps = 0,
                                                .lockstep_frames = 0,
                                                .every_kernel = false,
                                                .assume_inexact = true});
      EXPECT_FALSE(report.ok()) << constant << ", roots " << ulps << " ulp off";
    }
  }
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
    EXPECT_EQ(row.passes.size(), 5u);  // integrate, normals, and the three that look for divergence
    EXPECT_GT(row.ns_per_particle_substep.median, 0.0);
    EXPECT_NEAR(row.share_moved, 64 / row.ns_per_particle_substep.median / report.copy.best_gb_s(), 1e-9);
  }
  const std::string json = to_benchmark_json(report);
  for (const char* key :
       {"\"context\"", "\"benchmarks\"", "\"real_time\"", "\"time_unit\"", "integrate/32x32/damped"})
    EXPECT_NE(json.find(key), std::string::npos) << key;
}

}  // namespace
}  // namespace weft::test
