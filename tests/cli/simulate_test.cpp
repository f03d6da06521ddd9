// `weft simulate`: its summary in each format, its files, its times, its checks, and how it fails.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace weft::test {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// `weft simulate 1` at 5 × 5 particles on the CPU, with more words behind.
Arguments small(const Arguments& more) {
  Arguments all{"simulate", "1", "--device", "cpu", "--resolution", "5"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

OrderedJson summary(const Arguments& arguments) {
  Arguments all = arguments;
  all.insert(all.end(), {"--format", "json"});
  const Result result = weft(all);
  EXPECT_CODE(result, 0);
  return OrderedJson::parse(result.out);
}

TEST(Simulate, JsonHasExactlyTheDocumentedKeys) {
  const OrderedJson object = summary(small({"--time", "0.1"}));
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"device", "software", "solver", "precision", "substeps", "time_s",
                                            "wall_s", "spring_evaluations", "real_time_factor", "max_stretch",
                                            "p99_stretch", "energy_j", "hash"}));
  EXPECT_NEAR(object["time_s"].get<double>(), 0.1, 1e-12);
  EXPECT_GT(object["spring_evaluations"].get<std::uint64_t>(), 0u);
  EXPECT_EQ(object["hash"].get<std::string>().size(), 16u);
}

TEST(Simulate, CsvIsAHeaderAndOneRow) {
  const Result result = weft(small({"--time", "0.1", "--format", "csv"}));
  EXPECT_CODE(result, 0);
  const std::vector<std::string> lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].rfind("device,software,solver,precision,substeps,time_s,", 0), 0u);
  EXPECT_EQ(std::count(lines[1].begin(), lines[1].end(), ','), 12);
}

TEST(Simulate, TheLineNamesTheDeviceAndStderrStaysEmpty) {
  const Result result = weft(small({"--time", "0.1"}));
  EXPECT_CODE(result, 0);
  EXPECT_EQ(lines_of(result.out).size(), 1u);
  EXPECT_EQ(result.err, "");
  for (const char* part : {"CPU", " · no GPU · ", "leapfrog", "f32", "substeps", "simulated 0.1 s", "wall",
                           "real-time factor", "max stretch"})
    EXPECT_SAYS(result.out, part);
}

TEST(Simulate, TwoRunsEndInTheSameBits) {
  const Arguments run = small({"--time", "0.25"});
  EXPECT_EQ(summary(run)["hash"], summary(run)["hash"]);
}

// ⌊S/frame + 1e-6⌋ whole frames, then a short one; so any S is reached, to the rounding of sums of frames.
TEST(Simulate, TheStateIsAtTheTimeAskedFor) {
  for (const double time_s : {0.0, 0.001, 1.0 / 60.0, 0.02, 0.1234})
    EXPECT_NEAR(summary(small({"--time", std::to_string(time_s)}))["time_s"].get<double>(), time_s, 1e-6);
}

TEST(Simulate, SubstepsFrameAndPrecisionReachTheSolver) {
  const OrderedJson object =
      summary(small({"--time", "0.1", "--substeps", "41", "--frame", "0.02", "--precision", "f64"}));
  EXPECT_EQ(object["substeps"].get<int>(), 41);
  EXPECT_EQ(object["precision"], "f64");
  // 5 × 5 particles have 20 + 20 structural, 32 shear and 30 flex springs; the two pinned corners share none.
  // Leapfrog evaluates each n + 1 times a frame, and 0.1 s is 5 frames of 0.02 s.
  EXPECT_EQ(object["spring_evaluations"].get<std::uint64_t>(), 102u * 42u * 5u);
}

TEST(Simulate, TimeZeroWritesTheStartState) {
  const Scratch scratch;
  EXPECT_CODE(
      weft(small({"--time", "0", "--set", "cloth.imperfection=0", "--out", scratch.path("start.csv")})), 0);
  const std::vector<std::string> rows = lines_of(read_text(scratch.path("start.csv")));
  ASSERT_EQ(rows.size(), 26u);
  EXPECT_EQ(rows[0], "i,j,x,y,z,vx,vy,vz");
  EXPECT_EQ(rows[1].rfind("0,0,", 0), 0u);
  for (std::size_t r = 1; r < rows.size(); ++r)
    EXPECT_EQ(rows[r].substr(rows[r].size() - 6), ",0,0,0") << "at rest: " << rows[r];
}

/// Most significant digits that any number of a state.csv carries.
std::size_t most_digits(const std::string& text) {
  std::size_t most = 0;
  for (const std::string& row : lines_of(text)) {
    std::size_t digits = 0;
    bool leading = true, exponent = false;
    for (const char c : row + ",") {
      if (c == ',') {
        most = std::max(most, digits);
        digits = 0;
        leading = true;
        exponent = false;
      }
      if (c == 'e') exponent = true;
      if (exponent || std::isdigit(static_cast<unsigned char>(c)) == 0) continue;
      if (c != '0') leading = false;
      if (!leading) ++digits;
    }
  }
  return most;
}

TEST(Simulate, StateCsvHasNineDigitsForFloatAndSeventeenForDouble) {
  const Scratch scratch;
  EXPECT_CODE(weft(small({"--time", "0.1", "--out", scratch.path("f.csv")})), 0);
  EXPECT_CODE(weft(small({"--time", "0.1", "--precision", "f64", "--out", scratch.path("d.csv")})), 0);
  EXPECT_EQ(most_digits(read_text(scratch.path("f.csv"))), 9u);
  EXPECT_EQ(most_digits(read_text(scratch.path("d.csv"))), 17u);
}

TEST(Simulate, WritesEveryFormatAndNothingElse) {
  const Scratch scratch;
  for (const char* name : {"a.csv", "a.ply", "a.obj", "a.pc2"})
    EXPECT_CODE(weft(small({"--time", "0.05", "--out", scratch.path(name)})), 0);
  EXPECT_EQ(scratch.file_count(), 4u);
  EXPECT_EQ(read_text(scratch.path("a.ply")).rfind("ply\n", 0), 0u);
  EXPECT_SAYS(read_text(scratch.path("a.obj")), "\nf ");
  // A PC2 header is 32 bytes; then 25 points of 12 bytes for the start and each of the 3 frames.
  EXPECT_EQ(read_text(scratch.path("a.pc2")).size(), 32u + 25u * 12u * 4u);
}

TEST(Simulate, ChecksTheOutputPlaceBeforeSimulating) {
  const Scratch scratch;
  const Arguments long_run = {"--time", "100000", "--out"};
  const auto run = [&](const std::string& out) {
    Arguments more = long_run;
    more.push_back(out);
    return weft(small(more));
  };
  EXPECT_CODE(run(scratch.path("missing/state.csv")), 6);
  EXPECT_FALSE(std::filesystem::exists(scratch.path("missing")));
  EXPECT_CODE(run("/proc/state.csv"), 6);
  std::filesystem::create_directory(scratch.path("folder.csv"));
  EXPECT_CODE(run(scratch.path("folder.csv")), 6);
  const Result unknown = run(scratch.path("state.cvs"));
  EXPECT_CODE(unknown, 2);
  EXPECT_SAYS(unknown.err, ".csv, .ply, .obj, .pc2");
  EXPECT_SAYS(unknown.err, "did you mean .csv?");
}

TEST(Simulate, AWriteProtectedFileIsKept) {
  const Scratch scratch;
  write_text(scratch.path("kept.csv"), "precious");
  std::filesystem::permissions(scratch.path("kept.csv"), std::filesystem::perms::owner_read);
  const Result result = weft(small({"--time", "0.05", "--out", scratch.path("kept.csv")}));
  EXPECT_CODE(result, 6);
  EXPECT_SAYS(result.err, "write-protected");
  EXPECT_EQ(read_text(scratch.path("kept.csv")), "precious");
}

TEST(Simulate, AnInterruptedRunLeavesNoFile) {
  for (const char* name : {"state.csv", "state.pc2"}) {
    const Scratch scratch;
    const auto began = std::chrono::steady_clock::now();
    const Result result = weft_interrupted(small({"--time", "100000", "--out", scratch.path(name)}), [&] {
      return std::chrono::steady_clock::now() - began > std::chrono::milliseconds(400);
    });
    EXPECT_CODE(result, 130);
    EXPECT_SAYS(result.err, "interrupted at t = ");
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(scratch.file_count(), 0u) << name;
  }
}

TEST(Simulate, AClosedTerminalIsAnInterruption) {
  const Scratch scratch;
  const auto began = std::chrono::steady_clock::now();
  const auto ready = [&] {
    return std::chrono::steady_clock::now() - began > std::chrono::milliseconds(400);
  };
  const Result result =
      weft_interrupted(small({"--time", "100000", "--out", scratch.path("state.csv")}), ready, SIGHUP);
  EXPECT_CODE(result, 130);
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(Simulate, DivergenceAtAutomaticSubstepsNamesAnotherCure) {
  const Result result = weft(small({"--solver", "euler", "--time", "5"}));
  EXPECT_CODE(result, 4);
  EXPECT_SAYS(result.err, "another solver");
}

TEST(Simulate, DivergenceIsExitFourWithFrameAndParticle) {
  const Scratch scratch;
  const Result result = weft(small({"--substeps", "1", "--set", "material.membrane=1e6", "--time", "5",
                                    "--out", scratch.path("state.csv")}));
  EXPECT_CODE(result, 4);
  EXPECT_EQ(result.out, "");
  EXPECT_SAYS(result.err, "diverged");
  EXPECT_SAYS(result.err, "frame ");
  EXPECT_SAYS(result.err, "particle ");
  EXPECT_SAYS(result.err, "too few substeps");
  EXPECT_SAYS(result.err, "state.last-good.csv");
  EXPECT_EQ(scratch.file_count(), 1u);  // the last good state, and no result
}

// A sheet in free fall keeps its shape and falls g t²/2 = 1.226 m in half a second, so its highest particle
// is 1.226 m below the start's middle, for any material.
TEST(Simulate, CheckHoldsTheExpectBlockAgainstTheState) {
  const Scratch scratch;
  const auto scene = [&](const std::string& expect) {
    write_text(scratch.path("fall.toml"),
               "[cloth]\nresolution = 4\norientation = \"horizontal\"\n[gravity]\n[expect]\n" + expect);
    return weft({"simulate", scratch.path("fall.toml"), "--device", "cpu", "--check"});
  };
  const Result holds = scene("at_time = 0.5\nhighest_y = -1.22\nlowest_y = -1.24\nmax_stretch = 1e-4\n");
  EXPECT_CODE(holds, 0);
  EXPECT_SAYS(holds.out, "simulated 0.5 s");
  EXPECT_SAYS(holds.out, "expect.max_stretch");
  const Result broken = scene("at_time = 0.5\nhighest_y = -1.23\nlowest_y = -1.24\n");
  EXPECT_CODE(broken, 5);
  EXPECT_SAYS(broken.out, "expect.highest_y");
  EXPECT_SAYS(broken.out, "BROKEN");
  EXPECT_CODE(scene("at_time = 0.5\nlowest_y = -1.22\n"), 5);
}

TEST(Simulate, CheckRefusesARunThatDoesNotReachItsTime) {
  const Scratch scratch;
  write_text(scratch.path("a.toml"), "[cloth]\nresolution = 4\n[expect]\nat_time = 2.0\nmax_stretch = 0.1\n");
  EXPECT_CODE(weft({"simulate", scratch.path("a.toml"), "--device", "cpu", "--check", "--time", "1"}), 2);
  write_text(scratch.path("b.toml"), "[cloth]\nresolution = 4\n");
  EXPECT_CODE(weft({"simulate", scratch.path("b.toml"), "--device", "cpu", "--check"}), 2);
}

TEST(Simulate, BadScenesAreExitTwoWithTheirLine) {
  const Scratch scratch;
  write_text(scratch.path("bad.toml"), "[cloth]\nresolution = 8\nwidth = -1.0\n");
  const Result bad = weft({"simulate", scratch.path("bad.toml"), "--device", "cpu"});
  EXPECT_CODE(bad, 2);
  EXPECT_SAYS(bad.err, "bad.toml:3");
  EXPECT_SAYS(bad.err, "cloth.width");
  std::string garbage;
  for (int byte = 0; byte < 4096; ++byte) garbage += static_cast<char>(byte * 37 % 256);
  write_text(scratch.path("garbage.toml"), garbage);
  EXPECT_CODE(weft({"simulate", scratch.path("garbage.toml"), "--device", "cpu"}), 2);
  write_text(scratch.path("empty.toml"), "");
  EXPECT_CODE(weft({"simulate", scratch.path("empty.toml"), "--device", "cpu"}), 2);
  EXPECT_CODE(weft({"simulate", scratch.path("missing.toml"), "--device", "cpu"}), 2);
  EXPECT_CODE(weft({"simulate", scratch.folder().string(), "--device", "cpu"}), 2);
}

// Opening a pipe waits for its other end; that a run cannot be stopped while it does is the reason to refuse.
TEST(Simulate, PipesAreRefusedAndNotWaitedFor) {
  const Scratch scratch;
  const std::string out = scratch.path("out.csv"), scene = scratch.path("scene.toml");
  ASSERT_EQ(mkfifo(out.c_str(), 0600), 0);
  ASSERT_EQ(mkfifo(scene.c_str(), 0600), 0);
  EXPECT_CODE(weft({"simulate", "4", "--device", "cpu", "--time", "0", "--out", out}), 6);
  EXPECT_CODE(weft({"simulate", scene, "--device", "cpu", "--time", "0"}), 2);
}

TEST(Simulate, WarningsAreOnStderrUnlessQuiet) {
  const Scratch scratch;
  write_text(scratch.path("low.toml"),
             "[cloth]\nresolution = 4\ncenter = [0.0, -3.0, 0.0]\n[floor]\nheight = 0.0\n");
  const Arguments run{"simulate", scratch.path("low.toml"), "--device", "cpu", "--time", "0.02"};
  const Result loud = weft(run);
  EXPECT_CODE(loud, 0);
  EXPECT_SAYS(loud.err, "warning");
  Arguments hushed = run;
  hushed.push_back("-q");
  EXPECT_EQ(weft(hushed).err, "");
}

}  // namespace
}  // namespace weft::test
