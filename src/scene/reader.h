// Reads a scene file (TOML) into a Scene, refusing it whole on the first mistake with
// file:line, key, value, rule and cure.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace weft {

struct LoadedScene {
  Scene scene;
  std::vector<std::string> warnings;  ///< one sentence each, with the place
};

/// Changes the caller asks for on top of the file, in order: `--set section.key=value` strings (TOML values).
struct SceneOverrides {
  std::vector<std::string> set;
};

/// Finds a scene by number 1–6, by name in assets/scenes, or by path.
/// @throws Error(Exit::usage) naming the scenes there are when nothing matches.
std::filesystem::path find_scene(const std::string& number_name_or_path);

/// Reads, applies the overrides and checks everything, contradictions included.
/// @throws Error(Exit::usage) "file:line: section.key is VALUE; it must be RULE (cure)".
LoadedScene load_scene(const std::filesystem::path& file, const SceneOverrides& overrides = {});

/// The same from text; `name` stands for the file in messages. The fuzzer and the viewer's editor use it.
LoadedScene parse_scene(std::string_view text, const std::string& name, const SceneOverrides& overrides = {});

/// The assets folder: $WEFT_ASSETS, else beside the program, else the source tree it was built from.
std::filesystem::path assets_dir();

struct AssetInfo {
  std::string name, title;
  std::filesystem::path file;
};
std::vector<AssetInfo> list_scenes();      ///< scene 1 first, those without a number after the last
std::vector<AssetInfo> numbered_scenes();  ///< those that the keys 1 to 6 open
std::vector<AssetInfo> list_materials();   ///< by name

}  // namespace weft
