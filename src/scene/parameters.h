// The one table of parameters: file key, type, range, unit, default and meaning of everything a scene
// can say. The reader, `--set`, the sliders and the help all follow from its rows.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "scene/scene.h"

namespace weft {

/// A parameter's value as text formats see it: number, three numbers, two numbers, a word, or keys of a
/// motion.
using ParameterValue = std::variant<double, glm::dvec3, glm::dvec2, std::string, MotionKeys>;

enum class ParameterKind { number, integer, vec2, vec3, word, keys };

struct Parameter {
  std::string_view section = {};  ///< "material"; for lists, "pins" or "spheres"; empty for "title"
  std::string_view key = {};      ///< "density"
  ParameterKind kind = ParameterKind::number;
  double minimum = 0.0,
         maximum = 0.0;                               ///< allowed range of each number, inclusive
  bool required = false;                              ///< in its section
  double slider_minimum = 0.0, slider_maximum = 0.0;  ///< what a slider offers; equal when it offers none
  bool slider_logarithmic = false;
  std::string_view unit = {};     ///< "kg/m²", empty when none
  std::string_view about = {};    ///< one sentence of help
  std::string_view example = {};  ///< "cotton: 0.15", shown as the cure
  std::string_view words =
      {};  ///< allowed words separated by '|'; empty: any. A number with words takes both
  std::string_view default_text =
      {};  ///< where the default is no value of its own: "3/8 of membrane", "none"
  /// Reads from and writes to a scene whose section exists; `item` is the index in a list section.
  /// An absent optional number reads as NaN; "auto" substeps read as the word.
  ParameterValue (*get)(const Scene&, std::size_t item) = nullptr;
  void (*set)(Scene&, std::size_t item, const ParameterValue&) = nullptr;
};

/// Every parameter, in the order of docs/scene-format.md.
std::span<const Parameter> parameters();

/// The row of "section.key", or nullptr.
const Parameter* find_parameter(std::string_view section, std::string_view key);

/// Every section in file order: "cloth", "material", …, "expect".
std::span<const std::string_view> section_names();

/// Whether a section is a list of items: "pins", "spheres".
bool is_list_section(std::string_view section);

/// Whether an optional section stands in the scene (a list: has items); cloth, material and solver always do.
bool has_section(const Scene&, std::string_view section);

/// Adds the section with its defaults when it is absent, or one more item to a list.
void add_section(Scene&, std::string_view section);

/// Removes an optional section, or every item of a list; its effect is then not simulated.
void remove_section(Scene&, std::string_view section);

/// Removes one item of a list section.
void remove_item(Scene&, std::string_view section, std::size_t item);

/// Items of a list section; 1 or 0 for any other.
std::size_t item_count(const Scene&, std::string_view section);

/// "0.2", "[0, -9.81, 0]", "\"vertical\"".
std::string value_text(const ParameterValue&);

/// The default as documents show it; "required" when there is none.
std::string default_text(const Parameter&);

/// The rule as messages show it, without "it must be": "2 to 4096", "0.001 to 100, in kg/m²".
std::string rule_text(const Parameter&);

/// How a key of the parameter's motion names its place: "center".
std::string_view motion_place_name(const Parameter&);

/// Whether the keys of the parameter's motion may have a rotation.
bool motion_turns(const Parameter&);

/// Between two keys nothing moves faster, so that a slip of the unit is caught [m/s].
inline constexpr double kMotionFastest_m_s = 1000.0;

/// Between two keys nothing turns faster about an axis [°/s]: ten times in a second.
inline constexpr double kTurnFastest_deg_s = 3600.0;

/// How far anything is turned about an axis, at most [°]: a hundred times.
inline constexpr double kTurnFarthest_deg = 36000.0;

/// Checks kind, range and finiteness. Empty when the value is allowed, else the rule it breaks with its cure:
/// "it must be 2 to 4096 (40 draws well)". Sliders use it too.
std::string broken_rule(const Parameter&, const ParameterValue&);

}  // namespace weft
