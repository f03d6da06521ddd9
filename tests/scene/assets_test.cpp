// The scenes and materials that come with the program load without a warning and are found by every name.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "core/file.h"
#include "scene/parameters.h"
#include "scene/scene_text.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

TEST(Assets, SixScenesInOrderLoadWithoutWarnings) {
  const auto scenes = numbered_scenes();
  ASSERT_EQ(scenes.size(), 6u);
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const LoadedScene loaded = load_scene(scenes[k].file);
    EXPECT_TRUE(loaded.warnings.empty()) << loaded.warnings.at(0);
    EXPECT_EQ(scenes[k].name.substr(0, 2), std::to_string(k + 1) + "-");
    EXPECT_EQ(scenes[k].title, loaded.scene.title);
    EXPECT_FALSE(scenes[k].title.empty());
    ASSERT_TRUE(loaded.scene.expect.has_value()) << scenes[k].name;
    EXPECT_TRUE(loaded.scene.expect->max_stretch && loaded.scene.expect->at_time_s) << scenes[k].name;
    EXPECT_TRUE(loaded.scene.gravity.has_value());
  }
}

TEST(Assets, TheOtherScenesFollowAndLoadWithoutWarnings) {
  const auto scenes = list_scenes();
  ASSERT_GT(scenes.size(), 6u);
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    EXPECT_EQ(scenes[k].name.front() >= '1' && scenes[k].name.front() <= '6', k < 6) << scenes[k].name;
    const LoadedScene loaded = load_scene(scenes[k].file);
    EXPECT_TRUE(loaded.warnings.empty()) << scenes[k].name << ": " << loaded.warnings.at(0);
    EXPECT_TRUE(loaded.scene.expect.has_value()) << scenes[k].name;
  }
}

TEST(Assets, ScenesAreWhatTheirNumbersPromise) {
  const auto scene = [](const char* number) { return load_scene(find_scene(number)).scene; };
  EXPECT_TRUE(scene("1").pins.size() == 2 && scene("1").wind &&
              scene("1").cloth.orientation == Orientation::vertical);
  EXPECT_EQ(scene("2").pins.size(), 4u);
  EXPECT_EQ(scene("3").pins.size(), 1u);
  EXPECT_TRUE(scene("4").pins.empty() && scene("4").floor && scene("4").spheres.empty());
  EXPECT_TRUE(scene("5").pins.empty() && scene("5").spheres.size() == 1 &&
              scene("5").cloth.orientation == Orientation::horizontal);
  EXPECT_EQ(scene("6").pins.at(0).at, glm::dvec2(0.5));
}

TEST(Assets, MaterialsLoadAndNameTheirSource) {
  const auto materials = list_materials();
  EXPECT_GE(materials.size(), 6u);
  for (const AssetInfo& material : materials) {
    const LoadedScene loaded = read("[cloth]\n[material]\npreset = \"" + material.name + "\"\n");
    EXPECT_TRUE(loaded.warnings.empty());
    EXPECT_EQ(loaded.scene.material.preset, material.name);
    EXPECT_TRUE(contains(read_file(material.file), "\nsource = \"")) << material.name;
    EXPECT_FALSE(material.title.empty());
  }
}

TEST(Assets, AreFoundByNumberNameAndPath) {
  EXPECT_EQ(find_scene("1").filename(), "1-two-corners.toml");
  EXPECT_EQ(find_scene("two-corners"), find_scene("1"));
  EXPECT_EQ(find_scene("1-two-corners"), find_scene("1"));
  EXPECT_EQ(find_scene(find_scene("1").string()), find_scene("1"));
}

std::string message_of(const std::string& wanted) {
  try {
    load_scene(find_scene(wanted));
  } catch (const Error& mistake) {
    EXPECT_EQ(mistake.code(), Exit::usage) << mistake.what();
    return mistake.what();
  }
  return "loaded";
}

TEST(Assets, WhatIsNotASceneIsRefusedClearly) {
  EXPECT_TRUE(contains(message_of("7"), "1 to 6"));
  EXPECT_TRUE(contains(message_of("two-cornres"), "did you mean two-corners?"));
  EXPECT_TRUE(contains(message_of(""), "there is no scene"));
  EXPECT_TRUE(contains(message_of("nowhere/x.toml"), "there is no scene or file"));
  EXPECT_TRUE(contains(message_of("/"), "it is a folder"));
  EXPECT_TRUE(contains(message_of("/proc/self/exe"), "exe"));
  EXPECT_TRUE(contains(message_of("/dev/zero"), "1 MiB"));
}

TEST(Assets, AnotherFolderCanBeChosen) {
  const fs::path folder = fs::temp_directory_path() / ("weft-assets-test-" + std::to_string(getpid()));
  fs::create_directories(folder / "scenes");
  fs::create_directories(folder / "materials");
  write_file(folder / "scenes" / "1-mine.toml", "title = 'Mine'\n[cloth]\n");
  write_file(folder / "materials" / "bad.toml", "density = 0.1\npreset = 'other'\n");
  ::setenv("WEFT_ASSETS", folder.c_str(), 1);
  EXPECT_EQ(list_scenes().at(0).title, "Mine");
  EXPECT_EQ(find_scene("mine"), folder / "scenes" / "1-mine.toml");
  expect_refused("[cloth]\n[material]\npreset = 'bad'\n", {"bad.toml:2", "cannot name another"});
  write_file(folder / "materials" / "bad.toml", "density = -1\n");
  expect_refused("[cloth]\n[material]\npreset = 'bad'\n", {"bad.toml:1: material.density is -1"});
  ::setenv("WEFT_ASSETS", "/nowhere", 1);
  EXPECT_TRUE(contains(message_of("1"), "WEFT_ASSETS"));
  ::unsetenv("WEFT_ASSETS");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace weft
