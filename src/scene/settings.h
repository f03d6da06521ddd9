// One key with its value and place on its way into a scene, whether from a file, a preset or `--set`.
// Internal to src/scene.
#pragma once
#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/parameters.h"
#include "scene/scene.h"

namespace weft {

/// Where a key was given: "scene.toml:9" or "--set material.density=-1".
using Place = std::string;

/// Where in a scene a value goes.
struct Target {
  std::string_view section;
  std::size_t item = 0;  ///< index in a list section
};

/// A scene being read, with the place of each of its keys for messages about contradictions.
class Draft {
 public:
  Scene scene;

  /// Checks `node` against the key's row and writes it.
  /// @throws Error(Exit::usage) for an unknown key (with the nearest), a wrong type, or a value out of range
  void set(const Target& target, std::string_view key, const toml::node& node, const Place& place);

  /// Notes that a section, or an item of a list, begins at `place`.
  void note_section(const Target& target, const Place& place);

  /// The place of a key; of its section when the key is not given; of the file when neither is.
  Place place_of(const Target& target, std::string_view key = {}) const;

  bool is_given(const Target& target, std::string_view key) const;

  /// Takes the material of assets/materials/NAME.toml in place of the scene's.
  /// @throws Error(Exit::usage) naming the materials there are, or the mistake in the preset's file
  void take_preset(const std::string& name, const Place& place);

 private:
  void yield_preset(std::string_view key);

  std::set<std::string, std::less<>> preset_directions_;  ///< of warp and weft, that the preset gave
};

/// "spheres.0.radius", or "material.density": how messages and `--set` name a key, or a section.
std::string full_key(const Target& target, std::string_view key = {});

/// The value as a message shows it: a number, a quoted text, "a table", "a list of 3".
std::string node_text(const toml::node& node);

/// "did you mean X? " or nothing, then the names there are.
std::string suggestion(std::string_view word, std::span<const std::string_view> known);

/// Checks and applies one `--set` string.
void apply_override(Draft& draft, const std::string& text);

/// The preset a `--set material.preset=NAME` asks for, or nothing when `text` sets something else.
std::optional<std::string> preset_override(const std::string& text);

/// Refuses what is absent and required, and what contradicts itself.
void check_scene(const Draft& draft);

/// What is allowed but looks like a mistake, one sentence each: a start inside a sphere or below
/// the floor, pulled apart by pins, or too far away for a float.
std::vector<std::string> scene_warnings(const Draft& draft);

/// Parses TOML; a mistake of syntax becomes an Error with its line.
toml::table parse_toml(std::string_view text, const std::string& name);

/// A table's keys in the order of the file, so that the first mistake is the one reported.
using TableEntry = std::pair<const toml::key*, const toml::node*>;
std::vector<TableEntry> in_file_order(const toml::table& table);

/// Reads a scene or material file of sane size.
/// @throws Error(Exit::usage)
std::string read_toml_file(const std::filesystem::path& file);

}  // namespace weft
