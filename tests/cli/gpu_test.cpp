// The commands that need a Vulkan device: simulate and render on it, validate, bench.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/process.h"

namespace weft::test {
namespace {

using Json = nlohmann::json;

/// On the first Vulkan device unless `more` names another: where that is a software one, native is the
/// default.
Arguments on_device(const std::string& command, const Arguments& more) {
  Arguments all{command, "1", "--resolution", "9"};
  all.insert(all.end(), more.begin(), more.end());
  if (std::ranges::count(more, "--device") == 0) all.insert(all.end(), {"--device", "0"});
  return all;
}

/// As `weft COMMAND 1 --resolution 9 MORE` chooses the device.
Arguments by_default(const std::string& command, const Arguments& more) {
  Arguments all{command, "1", "--resolution", "9"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

bool only_software() {
  const Json devices = Json::parse(weft({"devices", "--format", "json"}).out);
  return devices[0]["software"].get<bool>();
}

/// The two numbers of "… 77 …; plan: 77 …".
std::pair<long, long> recorded_and_planned(const std::string& text, const std::string& what) {
  const std::size_t at = text.find(what), plan = text.find("plan: ", at);
  if (at == std::string::npos || plan == std::string::npos) return {-1, -2};
  return {std::stol(text.substr(at + what.size())), std::stol(text.substr(plan + 6))};
}

TEST(Device, SimulatesAndNamesTheDevice) {
  NEEDS_VULKAN();
  const Json devices = Json::parse(weft({"devices", "--format", "json"}).out);
  const Result result = weft(on_device("simulate", {"--time", "0.1", "--format", "json"}));
  EXPECT_CODE(result, 0);
  const std::string device = Json::parse(result.out)["device"];
  EXPECT_SAYS(device, devices[0]["name"].get<std::string>());
  EXPECT_EQ(device.find("(software)") != std::string::npos, devices[0]["software"].get<bool>());
}

// A kernel may take several substeps into a dispatch and have a scratch: the counts are held against the plan
// as that kernel runs it, and the plan itself is named beside them.
TEST(Device, RecordsAndAllocatesWhatThePlanSays) {
  NEEDS_VULKAN();
  const Json plan = Json::parse(weft(on_device("plan", {"--format", "json"})).out);
  for (const char* kernel : {"auto", "direct", "steal", "bands"}) {
    const Result result = weft(on_device("simulate", {"--time", "0.1", "-v", "--kernel", kernel}));
    EXPECT_CODE(result, 0);
    const auto dispatches = recorded_and_planned(result.err, "dispatches recorded ");
    EXPECT_EQ(dispatches.first, dispatches.second) << result.err;
    const auto bytes = recorded_and_planned(result.err, "bytes allocated ");
    EXPECT_EQ(bytes.first, bytes.second) << result.err;
    EXPECT_SAYS(result.err, std::to_string(plan["bytes"].get<long>()) + " bytes\n");
    if (kernel == std::string("direct")) {
      EXPECT_EQ(plan["bytes"].get<long>(), bytes.second);
    }
  }
}

TEST(Device, IsChosenByIndexByPartOfItsNameAndByUuid) {
  NEEDS_VULKAN();
  const Json first = Json::parse(weft({"devices", "--format", "json"}).out)[0];
  const std::string name = first["name"];
  for (const std::string& choice : {std::string("0"), name.substr(0, 5), first["uuid"].get<std::string>()})
    EXPECT_CODE(weft(on_device("simulate", {"--time", "0.02", "--device", choice})), 0) << choice;
}

TEST(Device, StagingAndRunTimeShadersEndInTheSameBits) {
  NEEDS_VULKAN();
  const auto hash = [](const Arguments& more) {
    Arguments all{"--time", "0.1", "--format", "json"};
    all.insert(all.end(), more.begin(), more.end());
    const Result result = weft(on_device("simulate", all));
    EXPECT_CODE(result, 0);
    return Json::parse(result.out)["hash"];
  };
  const Json plain = hash({});
  EXPECT_EQ(plain, hash({"--force-staging"}));
  EXPECT_EQ(plain, hash({"--shaders", WEFT_SOURCE_DIR "/shaders"}));
  EXPECT_EQ(plain, hash({"--validation"}));
}

// In double, what the device computes and what is drawn of it; software devices end in the reference's bits.
TEST(Device, ComputesInDouble) {
  NEEDS_VULKAN();
  const Json device = Json::parse(weft({"devices", "--format", "json"}).out)[0];
  if (!device["float64"].get<bool>()) GTEST_SKIP() << "no float64";
  const auto summary = [](const Arguments& more) {
    Arguments all{"--precision", "f64", "--solver", "rk4", "--time", "0.1", "--format", "json"};
    all.insert(all.end(), more.begin(), more.end());
    return Json::parse(weft(on_device("simulate", all)).out);
  };
  const Json on_gpu = summary({}), from_sources = summary({"--shaders", WEFT_SOURCE_DIR "/shaders"});
  EXPECT_EQ(on_gpu["precision"], "f64");
  EXPECT_EQ(on_gpu["hash"], from_sources["hash"]);
  if (device["software"].get<bool>()) {
    EXPECT_EQ(on_gpu["hash"], summary({"--device", "cpu"})["hash"]);
  }
  EXPECT_CODE(weft(on_device("validate", {"--precision", "f64"})), 0);
  EXPECT_CODE(weft(on_device("simulate", {"--precision", "f64", "--kernel", "strip", "--time", "0.1"})), 2);
  const Json timed =
      Json::parse(weft(on_device("bench", {"--precision", "f64", "--format", "json", "-q"})).out);
  EXPECT_EQ(timed["context"]["precision"], "f64");
}

TEST(Device, ABrokenShaderIsExitTwoWithItsLine) {
  NEEDS_VULKAN();
  const Scratch scratch;
  std::filesystem::copy(WEFT_SOURCE_DIR "/shaders", scratch.path("shaders"),
                        std::filesystem::copy_options::recursive);
  write_text(scratch.path("shaders/passes/integrate.comp"), "#version 460\nvoid main() {\n  nonsense;\n}\n");
  const Result result = weft(
      on_device("simulate", {"--time", "0.02", "--kernel", "direct", "--shaders", scratch.path("shaders")}));
  EXPECT_CODE(result, 2);
  EXPECT_SAYS(result.err, "integrate.comp:3");
}

TEST(Device, DivergenceIsExitFour) {
  NEEDS_VULKAN();
  const Result result =
      weft(on_device("simulate", {"--substeps", "1", "--set", "material.membrane=1e6", "--time", "5"}));
  EXPECT_CODE(result, 4);
  EXPECT_SAYS(result.err, "particle ");
}

// docs/cli.md "Devices": native where the best Vulkan device is a software one, said; with the same bits.
TEST(DefaultDevice, IsNativeWhereThereIsNoGpu) {
  NEEDS_VULKAN();
  if (!only_software()) GTEST_SKIP() << "there is a GPU here";
  const Result result = weft(by_default("simulate", {"--time", "0.1", "--format", "json"}));
  EXPECT_CODE(result, 0);
  const Json summary = Json::parse(result.out);
  EXPECT_EQ(summary["device"].get<std::string>().rfind("native (", 0), 0u) << summary["device"];
  EXPECT_EQ(summary["software"], true);
  EXPECT_SAYS(weft(by_default("simulate", {"--time", "0.1", "-q"})).out, " · no GPU · ");
  EXPECT_SAYS(result.err, "no GPU is used");
  const Json shaders = Json::parse(weft(on_device("simulate", {"--time", "0.1", "--format", "json"})).out);
  EXPECT_SAYS(shaders["device"].get<std::string>(), "(software)");
  EXPECT_EQ(shaders["hash"], summary["hash"]);
  EXPECT_EQ(weft(by_default("simulate", {"--time", "0.1", "-q"})).err, "");
}

// What speaks of shaders or of Vulkan means the Vulkan device.
TEST(DefaultDevice, IsTheVulkanDeviceWhereAnOptionSpeaksOfIt) {
  NEEDS_VULKAN();
  for (const Arguments& option :
       {Arguments{"--kernel", "direct"}, Arguments{"--force-staging"}, Arguments{"--validation"},
        Arguments{"--shaders", WEFT_SOURCE_DIR "/shaders"}}) {
    Arguments all{"--time", "0.02", "--format", "json"};
    all.insert(all.end(), option.begin(), option.end());
    const Result result = weft(by_default("simulate", all));
    EXPECT_CODE(result, 0);
    EXPECT_EQ(Json::parse(result.out)["device"].get<std::string>().find("native"), std::string::npos)
        << option[0];
  }
}

// What native lacks goes to the reference, by default as with --device native; one line says so.
TEST(DefaultDevice, WhatNativeLacksGoesToTheReferenceAndIsSaid) {
  NEEDS_VULKAN();
  if (!only_software()) GTEST_SKIP() << "there is a GPU here";
  for (const Arguments& more : {Arguments{}, Arguments{"--device", "native"}}) {
    Arguments all{"--time", "0.02", "--format", "json", "--solver", "rk4"};
    all.insert(all.end(), more.begin(), more.end());
    const Result result = weft(by_default("simulate", all));
    EXPECT_CODE(result, 0);
    EXPECT_SAYS(result.err, "native has no vector code for the pass rk4_first");
    EXPECT_SAYS(result.err, "CPU reference runs this");
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    EXPECT_EQ(Json::parse(result.out)["device"].get<std::string>(), "CPU reference (f32)");
  }
}

TEST(DefaultDevice, NativeStopsADivergingRunAsTheDeviceDoes) {
  const Result result = weft(by_default("simulate", {"--substeps", "1", "--set", "material.membrane=1e6",
                                                     "--time", "5", "--device", "native"}));
  EXPECT_CODE(result, 4);
  EXPECT_SAYS(result.err, "particle ");
}

// Native writes the vertex buffers themselves; mapped or, where the host does not see them, staged.
TEST(DefaultDevice, NativeIsDrawnToTheSamePixels) {
  NEEDS_VULKAN();
  if (!only_software()) GTEST_SKIP() << "a GPU ends in other bits";
  const Scratch scratch;
  const auto picture = [&](const std::string& name, const Arguments& more, const Environment& environment) {
    Arguments all{"--time", "0.2", "--size", "160x90", "--out", scratch.path(name), "-q"};
    all.insert(all.end(), more.begin(), more.end());
    EXPECT_CODE(weft(on_device("render", all), environment), 0);
    return read_text(scratch.path(name));
  };
  const std::string shaders = picture("shaders.png", {}, {});
  EXPECT_EQ(picture("native.png", {"--device", "native"}, {}), shaders);
  const std::string drawer = Json::parse(weft({"devices", "--format", "json"}).out)[0]["name"];
  const Arguments still{"--time", "0", "--size", "160x90", "--out", scratch.path("still.png"), "-q"};
  EXPECT_SAYS(weft(by_default("render", still)).out, " · drawn by " + drawer);
  EXPECT_EQ(picture("staged.png", {"--device", "native"}, {{"WEFT_FORCE_STAGING", "1"}}), shaders);
}

TEST(Validate, AgreesAndPrintsATable) {
  NEEDS_VULKAN();
  const Result result = weft(on_device("validate", {}));
  EXPECT_CODE(result, 0);
  EXPECT_SAYS(result.out, "integrate");
  EXPECT_SAYS(result.out, "lockstep");
  const Json report = Json::parse(weft(on_device("validate", {"--format", "json"})).out);
  EXPECT_TRUE(report["ok"].get<bool>());
  EXPECT_FALSE(report["rows"].empty());
}

TEST(Validate, AFalsifiedConstantIsExitFive) {
  NEEDS_VULKAN();
  const Result result = weft(on_device("validate", {"--perturb", "integrate.gravity"}));
  EXPECT_CODE(result, 5);
  EXPECT_SAYS(result.out, "over tolerance");
  EXPECT_CODE(weft(on_device("validate", {"--perturb", "integrate.nothing"})), 2);
}

// Nothing would be falsified, and the comparison would pass for the wrong reason.
TEST(Validate, AnEffectThatNoSceneHasCannotBeFalsified) {
  const Result result = weft({"validate", "1", "--perturb", "integrate.spheres"});
  EXPECT_CODE(result, 2);
  EXPECT_SAYS(result.err, "integrate.spheres");
  EXPECT_CODE(weft({"validate", "1", "--perturb", ""}), 2);
}

TEST(Validate, RefusesTheReferenceItself) {
  EXPECT_CODE(weft({"validate", "1", "--device", "cpu"}), 2);
  EXPECT_CODE(weft({"bench", "1", "--device", "cpu"}), 2);
}

TEST(Bench, JsonHasGoogleBenchmarksShape) {
  NEEDS_VULKAN();
  const Result result = weft({"bench", "1", "--resolution", "32", "--format", "json", "-q"});
  EXPECT_CODE(result, 0);
  const Json report = Json::parse(result.out);
  EXPECT_TRUE(report["context"].is_object());
  ASSERT_FALSE(report["benchmarks"].empty());
  for (const Json& benchmark : report["benchmarks"]) {
    for (const char* key : {"name", "run_type", "iterations", "real_time", "cpu_time", "time_unit"})
      EXPECT_TRUE(benchmark.contains(key)) << key;
    EXPECT_GT(benchmark["real_time"].get<double>(), 0.0);
  }
}

/// Width and height in a PNG's header.
std::pair<unsigned, unsigned> png_size(const std::string& bytes) {
  if (bytes.size() < 24 || bytes.compare(1, 3, "PNG") != 0) return {0, 0};
  const auto word = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
    return value;
  };
  return {word(16), word(20)};
}

TEST(Render, WritesOnePictureOfTheSizeAskedFor) {
  NEEDS_VULKAN();
  const Scratch scratch;
  for (const Arguments& look :
       {Arguments{}, Arguments{"--wireframe"}, Arguments{"--shading", "flat"}, Arguments{"--samples", "4"}}) {
    Arguments more{"--time", "0.05", "--size", "160x90", "--out", scratch.path("a.png")};
    more.insert(more.end(), look.begin(), look.end());
    EXPECT_CODE(weft(on_device("render", more)), 0);
    EXPECT_EQ(png_size(read_text(scratch.path("a.png"))), std::pair(160u, 90u));
  }
  EXPECT_EQ(scratch.file_count(), 1u);
}

// Four pictures: at 0, 1/30, 2/30 and 3/30 s.
TEST(Render, ASequenceMakesItsFolderAndKeepsTheRate) {
  NEEDS_VULKAN();
  const Scratch scratch;
  EXPECT_CODE(weft(on_device("render", {"--time", "0.1", "--fps", "30", "--size", "64x64", "--out",
                                        scratch.path("new/frame-%04d.png")})),
              0);
  for (const char* name : {"new/frame-0000.png", "new/frame-0003.png"})
    EXPECT_EQ(png_size(read_text(scratch.path(name))), std::pair(64u, 64u)) << name;
  EXPECT_FALSE(std::filesystem::exists(scratch.path("new/frame-0004.png")));
}

TEST(Render, WritesAFilm) {
  NEEDS_VULKAN();
  const Scratch scratch;
  const Result result =
      weft(on_device("render", {"--time", "0.1", "--size", "64x64", "--out", scratch.path("a.mp4")}));
  EXPECT_CODE(result, 0);
  EXPECT_SAYS(result.out, "7 pictures");  // the start and six frames
  EXPECT_EQ(read_text(scratch.path("a.mp4")).substr(4, 4), "ftyp");
  EXPECT_EQ(scratch.file_count(), 1u);
}

TEST(Render, DrawsWhatTheCpuComputes) {
  NEEDS_VULKAN();
  const Scratch scratch;
  EXPECT_CODE(weft(on_device("render", {"--device", "cpu", "--precision", "f64", "--time", "0.05", "--size",
                                        "64x64", "--out", scratch.path("a.png")})),
              0);
  EXPECT_EQ(png_size(read_text(scratch.path("a.png"))), std::pair(64u, 64u));
}

TEST(Render, RefusesWhatItCannotWrite) {
  const Scratch scratch;
  EXPECT_CODE(weft(on_device("render", {})), 2);  // no --out
  EXPECT_CODE(weft(on_device("render", {"--out", scratch.path("a.gif")})), 2);
  EXPECT_CODE(weft(on_device("render", {"--out", scratch.path("no/a.png")})), 6);
  EXPECT_CODE(weft(on_device("render", {"--out", scratch.path("no/a.mp4")})), 6);
  for (const char* size : {"0x10", "64", "64x", "axb", "99999x64", "64x64x64"})
    EXPECT_CODE(weft(on_device("render", {"--size", size, "--out", scratch.path("a.png")})), 2) << size;
  EXPECT_CODE(weft(on_device("render", {"--samples", "3", "--out", scratch.path("a.png")})), 2);
  EXPECT_CODE(weft(on_device("render", {"--fps", "120", "--out", scratch.path("a.mp4")})), 2);
  EXPECT_EQ(scratch.file_count(), 0u);
}

TEST(Render, AnInterruptedFilmLeavesNoFile) {
  NEEDS_VULKAN();
  const Scratch scratch;
  const auto some_file = [&] { return scratch.file_count() > 0; };
  const Result result = weft_interrupted(
      on_device("render", {"--time", "1000", "--size", "64x64", "--out", scratch.path("a.mp4")}), some_file);
  EXPECT_CODE(result, 130);
  EXPECT_EQ(scratch.file_count(), 0u);
}

}  // namespace
}  // namespace weft::test
