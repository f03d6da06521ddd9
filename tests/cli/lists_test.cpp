// The lists and the plan: shape of each format, and that what a list names is accepted elsewhere.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "cli/process.h"

namespace weft::test {
namespace {

using Json = nlohmann::json;

Json json_of(const Arguments& arguments) {
  const Result result = weft(arguments);
  EXPECT_CODE(result, 0);
  return Json::parse(result.out);
}

TEST(Lists, EachHasTheSameRowsInEveryFormat) {
  for (const std::string list : {"scenes", "materials", "solvers", "devices"}) {
    const Json rows = json_of({list, "--format", "json"});
    ASSERT_FALSE(rows.empty()) << list;
    const std::vector<std::string> csv = lines_of(weft({list, "--format", "csv"}).out);
    const std::vector<std::string> human = lines_of(weft({list}).out);
    EXPECT_EQ(csv.size(), rows.size() + 1) << list;
    EXPECT_EQ(human.size(), rows.size() + 1) << list;
    EXPECT_EQ(std::count(csv[0].begin(), csv[0].end(), ',') + 1, static_cast<long>(rows[0].size())) << list;
  }
}

TEST(Lists, SixScenesAreFoundByNumberAndAllByName) {
  const Json scenes = json_of({"scenes", "--format", "json"});
  ASSERT_GT(scenes.size(), 6u);
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const Json& scene = scenes[k];
    if (k >= 6) {
      EXPECT_EQ(scene["number"], "") << scene["name"];
      EXPECT_EQ(json_of({"plan", scene["name"], "--format", "json"})["scene"], scene["title"]);
      continue;
    }
    const std::string number = std::to_string(scene["number"].get<int>());
    const Json by_number = json_of({"plan", number, "--format", "json"});
    EXPECT_EQ(by_number, json_of({"plan", scene["name"], "--format", "json"}));
    EXPECT_EQ(by_number, json_of({"plan", scene["file"], "--format", "json"}));
    EXPECT_NE(scene["title"], "");
  }
}

TEST(Lists, EveryMaterialAndSolverRuns) {
  for (const Json& material : json_of({"materials", "--format", "json"})) {
    EXPECT_GT(material["density_kg_m2"].get<double>(), 0.0);
    EXPECT_CODE(weft({"simulate", "1", "--device", "cpu", "--resolution", "5", "--time", "0.02", "--material",
                      material["name"]}),
                0);
  }
  for (const Json& solver : json_of({"solvers", "--format", "json"}))
    EXPECT_CODE(weft({"simulate", "1", "--device", "cpu", "--resolution", "5", "--time", "0.02",
                      "--precision", "f64", "--solver", solver["name"]}),
                0);
}

TEST(Lists, AMaterialReplacesTheScenesOwn) {
  const Scratch scratch;
  write_text(scratch.path("a.toml"), "[cloth]\nresolution = 5\n[gravity]\n[material]\ndensity = 7.5\n");
  const auto energy = [&](const Arguments& more) {
    Arguments all{"simulate", scratch.path("a.toml"), "--device", "cpu", "--time", "0.1", "--format", "json"};
    all.insert(all.end(), more.begin(), more.end());
    return json_of(all)["energy_j"].get<double>();
  };
  EXPECT_NE(energy({}), energy({"--material", "denim"}));
}

TEST(Lists, SoftwareDevicesAreFlagged) {
  NEEDS_VULKAN();
  for (const Json& device : json_of({"devices", "--format", "json"})) {
    if (device["index"] == "cpu" || device["index"] == "native") continue;  // no Vulkan devices
    EXPECT_EQ(device["software"].get<bool>(), device["type"] == "software");
    EXPECT_EQ(device["uuid"].get<std::string>().empty(), false);
  }
}

TEST(Plan, JsonHasTheDocumentedShapeAndItsBytesAddUp) {
  const Json plan = json_of({"plan", "1", "--format", "json"});
  for (const char* key : {"steps", "buffers", "left_out", "bytes"}) EXPECT_TRUE(plan.contains(key)) << key;
  std::uint64_t bytes = 0;
  for (const Json& buffer : plan["buffers"]) bytes += buffer["bytes"].get<std::uint64_t>();
  EXPECT_EQ(bytes, plan["bytes"].get<std::uint64_t>());
  for (const Json& step : plan["steps"])
    for (const char* key : {"pass", "repeat", "range", "constants"}) EXPECT_TRUE(step.contains(key)) << key;
  for (const Json& effect : plan["left_out"]) EXPECT_NE(effect["reason"], "");
}

TEST(Plan, AnEffectThatASceneAddsIsNoLongerLeftOut) {
  const auto left_out = [](const Arguments& arguments) {
    std::set<std::string> effects;
    const Json plan = json_of(arguments);
    for (const Json& effect : plan["left_out"]) effects.insert(effect["effect"]);
    return effects;
  };
  const Scratch scratch;
  write_text(scratch.path("bare.toml"), "[cloth]\nresolution = 8\n");
  const auto bare = left_out({"plan", scratch.path("bare.toml"), "--format", "json"});
  const auto with_floor =
      left_out({"plan", scratch.path("bare.toml"), "--set", "floor.height=-2", "--format", "json"});
  EXPECT_EQ(bare.size(), with_floor.size() + 1);
}

TEST(Plan, PrintsForPeopleAndAsCsv) {
  EXPECT_SAYS(weft({"plan", "1"}).out, "integrate");
  const std::vector<std::string> csv = lines_of(weft({"plan", "1", "--format", "csv"}).out);
  ASSERT_GE(csv.size(), 2u);
  EXPECT_EQ(csv[0], "pass,repeat,range_x,range_y,constants");
}

}  // namespace
}  // namespace weft::test
