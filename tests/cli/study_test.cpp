// `weft study` and the options that choose from one, as a person runs them: files, mistakes, interruption.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace weft::test {
namespace {

/// A cloth so small that a study of it takes a second; its cache is the folder's own.
class SmallStudy : public ::testing::Test {
 protected:
  Arguments study(const Arguments& more = {}) const {
    Arguments all{"study",       scratch_.path("small.toml"),
                  "--device",    "cpu",
                  "--quick",     "--time",
                  "0.05",        "--solvers",
                  "leapfrog,rk4"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Arguments simulate(const Arguments& more) const {
    Arguments all{"simulate", scratch_.path("small.toml"), "--device", "cpu", "--time", "0.05"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void SetUp() override {
    write_text(scratch_.path("small.toml"),
               "title = \"small\"\n[cloth]\nresolution = 9\nimperfection = 0.01\n[material]\nmembrane = 100\n"
               "[[pins]]\nat = [0, 0]\n[[pins]]\nat = [1, 0]\n[gravity]\n");
  }
  Scratch scratch_;
  Environment own_cache_{{"XDG_CACHE_HOME", scratch_.path("cache")}};
};

void expect_refused(const Result& result, const std::vector<std::string>& parts) {
  EXPECT_CODE(result, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.rfind("weft: ", 0), 0u) << result.err;
  for (const std::string& part : parts) EXPECT_SAYS(result.err, part);
}

TEST_F(SmallStudy, WritesEveryFile) {
  const std::string folder = scratch_.path("report");
  const Result result =
      weft(study({"--out", folder, "--resolutions", "5,9", "--format", "json"}), own_cache_);
  EXPECT_CODE(result, 0);
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["cloths"].size(), 2u);
  EXPECT_EQ(json, nlohmann::json::parse(read_text(folder + "/points.json")));
  EXPECT_EQ(lines_of(read_text(folder + "/points.csv")).size(), 1 + json["points"].size());
  for (const char* name : {"/work-precision-5.svg", "/work-precision-9.svg", "/work-precision-9-springs.svg"})
    EXPECT_SAYS(read_text(folder + name), "</svg>");
  EXPECT_SAYS(read_text(folder + "/report.html"), "weft study");
}

TEST_F(SmallStudy, RefusesWhatItCannotMean) {
  const std::string out = scratch_.path("report");
  expect_refused(weft(study()), {"--out is missing"});
  expect_refused(weft(study({"--out", out, "--substeps", "9"})), {"--substeps", "sweeps"});
  expect_refused(weft(study({"--out", out, "--solver", "rk4"})), {"--solver", "--solvers"});
  expect_refused(weft(study({"--out", out, "--resolution", "9", "--resolutions", "9"})), {"--resolutions"});
  expect_refused(weft(study({"--out", out, "--resolutions", "9,,5"})), {"--resolutions", "9,,5", "commas"});
  expect_refused(weft(study({"--out", out, "--resolutions", "1"})), {"--resolutions", "1", "2 to 4096"});
  expect_refused(weft(study({"--out", out, "--precisions", "f16"})), {"f16", "f32, f32k"});
  expect_refused(weft({"study", "1", "--out", out, "--solvers", "leapfrg"}), {"leapfrg", "leapfrog"});
  expect_refused(weft({"study", "1", "--out", out, "--time", "0"}), {"--time is 0"});
  EXPECT_CODE(weft(study({"--out", scratch_.path("no/such/report")})), 6);
  EXPECT_EQ(scratch_.file_count(), 1u);  // the scene alone
}

TEST_F(SmallStudy, AnInterruptedOneGoesOn) {
  const std::string folder = scratch_.path("report");
  Arguments slow = study({"--out", folder, "--precisions", "f64"});
  slow[6] = "20";  // seconds of cloth
  const auto first_point = [&] {
    std::error_code failure;
    return !std::filesystem::is_empty(folder + "/points", failure) && !failure;
  };
  setenv("XDG_CACHE_HOME", scratch_.path("cache").c_str(), 1);
  const Result stopped = weft_interrupted(slow, first_point);
  unsetenv("XDG_CACHE_HOME");
  EXPECT_CODE(stopped, 130);
  EXPECT_SAYS(stopped.err, "goes on from there");
  EXPECT_FALSE(std::filesystem::exists(folder + "/report.html"));
}

TEST_F(SmallStudy, AnErrorChoosesTheCheapestBelowIt) {
  const Result coarse = weft(simulate({"--error", "1e-2", "--format", "json"}), own_cache_);
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  EXPECT_SAYS(coarse.err, "measuring in quick form");
  EXPECT_SAYS(coarse.err, "chosen: ");
  const Result again = weft(simulate({"--error", "1e-2", "--format", "json"}), own_cache_);
  EXPECT_EQ(again.err.find("measuring"), std::string::npos) << again.err;
  const auto first = nlohmann::json::parse(coarse.out), second = nlohmann::json::parse(again.out);
  for (const char* key : {"solver", "precision", "substeps", "hash"})
    EXPECT_EQ(first[key], second[key]) << key;
  expect_refused(weft(simulate({"--error", "1e-14", "-q"}), own_cache_),
                 {"--error is 1e-14", "most accurate is"});
  EXPECT_CODE(weft(simulate({"--budget", "1000"}), own_cache_), 0);
  expect_refused(weft(simulate({"--budget", "1e-5", "-q"}), own_cache_),
                 {"--budget is 1e-05", "misses it by"});
}

TEST_F(SmallStudy, ContradictionsAreRefusedBeforeAnythingRuns) {
  expect_refused(weft(simulate({"--error", "1e-3", "--budget", "8"})), {"--error and --budget"});
  expect_refused(weft(simulate({"--error", "1e-3", "--substeps", "8"})), {"--error and --substeps"});
  expect_refused(weft(simulate({"--budget", "8", "--solver", "rk4"})), {"--budget and --solver"});
  expect_refused(weft(simulate({"--error", "0"})), {"--error", "0"});
  expect_refused(weft(simulate({"--error", "nan"})), {"--error", "nan"});
  expect_refused(weft(simulate({"--budget", "-3"})), {"--budget", "-3"});
  expect_refused(weft({"simulate", "1", "--device", "cpu", "--time", "0", "--error", "1e-3"}), {"--time 0"});
}

}  // namespace
}  // namespace weft::test
