// `weft bench` on native: the tables a machine without a GPU gives, and what they say of themselves.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace weft::test {
namespace {

Arguments bench_of(const Arguments& more) {
  Arguments all{"bench", "1", "--effects", "--resolution", "16", "--time", "0.02", "--format", "json"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// Contact with spheres and capsules is part of the sweep: as many bytes as without. A capsule has a step of
// its own in the plan, in each of the frame's substeps, and nothing else comes with it.
TEST(BenchEffects, MeasuresNativeByTheWallClockAndByProcessorTime) {
  const Result result = weft(bench_of({"--device", "native", "--only", "spheres,capsules"}));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto rows = nlohmann::json::parse(result.out);
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    EXPECT_EQ(row["state"], "idle");
    for (const char* const time :
         {"ms_with", "ms_without", "processor_ms_with", "processor_ms_without", "toggle_ms"})
      EXPECT_GT(row[time].get<double>(), 0.0) << time;
    EXPECT_TRUE(row["absent_percent"].is_null()) << "no build of native lacks an effect";
    EXPECT_SAYS(row["kernel_with"].get<std::string>(), "native (");
  }
  EXPECT_EQ(rows[0]["effect"], "spheres");
  EXPECT_EQ(rows[0]["bytes_with"], rows[0]["bytes_without"]);
  EXPECT_EQ(rows[0]["dispatches_with"], rows[0]["dispatches_without"]);
  EXPECT_EQ(rows[1]["effect"], "capsules");
  EXPECT_EQ(rows[1]["bytes_with"], rows[1]["bytes_without"]);
  EXPECT_EQ(rows[1]["dispatches_with"].get<int>(),
            rows[1]["dispatches_without"].get<int>() + rows[1]["substeps_with"].get<int>());
}

// Tearing stands beside no strain limit: that row says so, and the others are there.
TEST(BenchEffects, LeavesOutWhatTheSceneExcludes) {
  const Result result =
      weft({"bench", "1", "--effects", "--resolution", "16", "--time", "0.02", "--device", "native", "--only",
            "strain_limit,tearing", "--set", "material.strain_limit=0.1"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_SAYS(result.out, "tearing: not measured");
  EXPECT_SAYS(result.out, "  strain_limit  at work");
}

TEST(BenchEffects, RefusesWhatNativeDoesNotRunAndSaysHowToGoOn) {
  const Result doubles = weft(bench_of({"--device", "native", "--precision", "f64"}));
  EXPECT_CODE(doubles, 2);
  EXPECT_SAYS(doubles.err, "f32 only");
  EXPECT_SAYS(doubles.err, "--device with a Vulkan one");
  const Result kernel = weft(bench_of({"--device", "native", "--kernel", "texel"}));
  EXPECT_CODE(kernel, 2);
  EXPECT_SAYS(kernel.err, "--kernel and --device native are both given");
}

// docs/cli.md "weft bench": native, the Vulkan device and the reference by turns in one run. No number stands
// where none was measured, and the Vulkan device's row says which kernel it is.
TEST(BenchBackends, SaysWhatEachRowIsAndNothingThatWasNotMeasured) {
  const Result result = weft({"bench", "1", "--resolution", "16", "--device", "native", "--kernel", "texel",
                              "--format", "json", "-q"});
  ASSERT_EQ(result.code, 0) << result.err;
  bool one_thread = false, reference = false;
  for (const auto& row : nlohmann::json::parse(result.out)) {
    const std::string backend = row["backend"];
    const bool native = backend.rfind("native (", 0) == 0, free = row["cores"] == "free";
    EXPECT_GT(row["ns_per_particle_substep"].get<double>(), 0.0) << backend;
    EXPECT_GE(row["ns_median"], row["ns_per_particle_substep"]) << backend;
    EXPECT_GT(row["frame_ms"].get<double>(), 0.0) << backend;
    EXPECT_EQ(row["divider_share"].is_number(), native && free) << backend;
    EXPECT_EQ(row["divider_ns"].is_number(), native && free) << backend;
    const bool on_host = native || backend == "CPU reference (f32)";
    EXPECT_EQ(row["kernel"].is_string(), !on_host) << backend;
    if (!on_host) {
      EXPECT_SAYS(row["kernel"].get<std::string>(), "texel");
    }
    one_thread = one_thread || (native && free && row["threads_most"] == 1);
    reference = reference || backend == "CPU reference (f32)";
  }
  EXPECT_TRUE(one_thread);
  EXPECT_TRUE(reference);
}

TEST(BenchBackends, TakesOneKernelOfTheVulkanDevice) {
  const Result all = weft({"bench", "1", "--resolution", "16", "--device", "native", "--kernel", "all"});
  EXPECT_CODE(all, 2);
  EXPECT_SAYS(all.err, "--kernel is all and --device is native");
}

}  // namespace
}  // namespace weft::test
