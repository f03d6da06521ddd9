// The one table of parameters: file key, type, range, unit, default and meaning of everything a scene
// can say. The reader, `--set`, the sliders and the help all follow from its rows.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/scene.h"

namespace weft {

/// A parameter's value as text formats see it: number, three numbers, two numbers, or a word.
using ParameterValue = std::variant<double, glm::dvec3, glm::dvec2, std::string>;

enum class ParameterKind { number, integer, vec2, vec3, word };

struct Parameter {
  std::string_view section;  ///< "material"; for lists, "pins" or "spheres"
  std::string_view key;      ///< "density"
  ParameterKind kind;
  double minimum, maximum;   ///< allowed range of each number, inclusive unless `exclusive_minimum`
  bool exclusive_minimum = false;
  bool required = false;     ///< in its section
  double slider_minimum, slider_maximum;  ///< what a slider offers; equal when it offers none
  bool slider_logarithmic = false;
  std::string_view unit;     ///< "kg/m²", empty when none
  std::string_view about;    ///< one sentence of help
  std::string_view example;  ///< "cotton: 0.15", shown as the cure
  std::string_view words;    ///< for words: allowed values separated by '|', empty when open
  /// Reads from and writes to a scene whose section exists; `item` is the index in a list section.
  ParameterValue (*get)(const Scene&, std::size_t item);
  void (*set)(Scene&, std::size_t item, const ParameterValue&);
};

/// Every parameter, in the order of docs/scene-format.md.
std::span<const Parameter> parameters();

/// The row of "section.key", or nullptr.
const Parameter* find_parameter(std::string_view section, std::string_view key);

/// Whether an optional section stands in the scene, and adding or removing it (with its defaults).
bool has_section(const Scene&, std::string_view section);

}  // namespace weft
