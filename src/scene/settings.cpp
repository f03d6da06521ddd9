// Checking one key against its row of the parameter table and writing it into the scene.
#include "scene/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "scene/motion_keys.h"
#include "scene/reader.h"

namespace weft {
namespace {

/// A number, whether written as an integer or with a point; nothing for any other type.
std::optional<double> number_of(const toml::node* node) {
  if (node == nullptr || !node->is_number()) return std::nullopt;
  return node->value<double>();
}

/// The node as the parameter's kind of value, or nothing when its type does not fit.
std::optional<ParameterValue> value_of(const Parameter& parameter, const toml::node& node) {
  if (const auto* text = node.as_string()) return ParameterValue(text->get());
  if (parameter.kind == ParameterKind::integer && node.is_floating_point()) return std::nullopt;
  if (const auto number = number_of(&node)) return ParameterValue(*number);
  const toml::array* list = node.as_array();
  const std::size_t length = parameter.kind == ParameterKind::vec2 ? 2 : 3;
  if (list == nullptr || list->size() != length) return std::nullopt;
  glm::dvec3 numbers(0.0);
  for (std::size_t k = 0; k < length; ++k) {
    const auto number = number_of(list->get(k));
    if (!number) return std::nullopt;
    numbers[static_cast<int>(k)] = *number;
  }
  if (length == 2) return ParameterValue(glm::dvec2(numbers.x, numbers.y));
  return ParameterValue(numbers);
}

/// The value in a refusal: 8.0 for a whole number is not shown as the 8 that would be right.
std::string refused_text(const Parameter& parameter, const toml::node& node) {
  const std::string text = node_text(node);
  const bool point_lost = parameter.kind == ParameterKind::integer && node.is_floating_point() &&
                          text.find_first_not_of("-0123456789") == std::string::npos;
  return point_lost ? text + ".0" : text;
}

/// "; did you mean X?" where a word is nearly one of those allowed.
std::string nearest_word(const Parameter& parameter, const toml::node& node) {
  const auto* text = node.as_string();
  if (text == nullptr || parameter.words.empty()) return {};
  std::vector<std::string_view> words;
  for (std::string_view rest = parameter.words; !rest.empty();) {
    const std::size_t bar = std::min(rest.find('|'), rest.size());
    words.push_back(rest.substr(0, bar));
    rest.remove_prefix(std::min(bar + 1, rest.size()));
  }
  const std::string_view nearest = nearest_name(text->get(), words);
  return nearest.empty() ? std::string() : fmt::format("; did you mean {}?", nearest);
}

std::vector<std::string_view> keys_of(std::string_view section) {
  std::vector<std::string_view> keys;
  for (const Parameter& parameter : parameters())
    if (parameter.section == section) keys.push_back(parameter.key);
  return keys;
}

[[noreturn]] void refuse_unknown_key(const Target& target, std::string_view key, const Place& place) {
  const auto known = keys_of(target.section);
  if (target.section == "cloths" && find_parameter("cloth", key) != nullptr)
    throw error(Exit::usage,
                "{}: {} stands in [[cloths]]; it must be in [cloth], since every cloth has the same size and "
                "resolution (move it there; a further cloth has {})",
                place, in_quotes(key), joined(known));
  throw error(Exit::usage, "{}: {} is not a key of [{}]; {}", place, in_quotes(key), target.section,
              suggestion(key, known));
}

}  // namespace

std::string full_key(const Target& target, std::string_view key) {
  if (target.section.empty()) return std::string(key);
  const std::string section = is_list_section(target.section)
                                  ? fmt::format("{}.{}", target.section, target.item)
                                  : std::string(target.section);
  return key.empty() ? section : fmt::format("{}.{}", section, key);
}

std::string node_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return in_quotes(text->get());
  if (node.is_table()) return "a table";
  if (const auto* list = node.as_array()) {
    std::string text = "[";
    for (std::size_t k = 0; k < list->size() && k < 4; ++k)
      text += (k > 0 ? ", " : "") + node_text(*list->get(k));
    return text + (list->size() > 4 ? fmt::format(", …] ({} items)", list->size()) : "]");
  }
  if (const auto number = number_of(&node)) return short_number(*number);
  if (const auto flag = node.value<bool>()) return *flag ? "true" : "false";
  return "a date or time";
}

std::string suggestion(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_name(word, known);
  const std::string names = fmt::format("there {} {}", known.size() == 1 ? "is" : "are", joined(known));
  return nearest.empty() ? names : fmt::format("did you mean {}? ({})", nearest, names);
}

void Draft::set(const Target& target, std::string_view key, const toml::node& node, const Place& place) {
  const Parameter* parameter = find_parameter(target.section, key);
  if (parameter == nullptr) refuse_unknown_key(target, key, place);
  if (parameter->kind == ParameterKind::keys) {
    parameter->set(scene, target.item, read_motion(*parameter, full_key(target, key), node, place));
    scene.places[full_key(target, key)] = place;
    return;
  }
  const auto value = value_of(*parameter, node);
  const auto wrong_type = ParameterValue(glm::dvec2(std::numeric_limits<double>::quiet_NaN()));
  const std::string rule = broken_rule(*parameter, value.value_or(wrong_type));
  if (!rule.empty())
    throw error(Exit::usage, "{}: {} is {}; {}{}", place, full_key(target, key),
                refused_text(*parameter, node), rule, nearest_word(*parameter, node));
  parameter->set(scene, target.item, *value);
  scene.places[full_key(target, key)] = place;
  if (target.section == "material") yield_preset(key);
}

/// A scene's `membrane` or `bend` overrides what its preset says of warp and weft.
void Draft::yield_preset(std::string_view key) {
  MaterialSection& material = scene.material;
  const auto drop = [&](std::string_view direction, std::optional<double>& value) {
    if (preset_directions_.erase(std::string(direction)) > 0) value.reset();
  };
  if (key == "membrane") {
    drop("membrane_warp", material.membrane_warp_n_m);
    drop("membrane_weft", material.membrane_weft_n_m);
  } else if (key == "bend") {
    drop("bend_warp", material.bend_warp_n_m);
    drop("bend_weft", material.bend_weft_n_m);
  }
  preset_directions_.erase(std::string(key));  // given by the scene itself
}

void Draft::note_section(const Target& target, const Place& place) {
  scene.places.emplace(full_key(target), place);
}

Place Draft::place_of(const Target& target, std::string_view key) const {
  return weft::place_of(scene, full_key(target, key));
}

bool Draft::is_given(const Target& target, std::string_view key) const {
  return scene.places.contains(full_key(target, key));
}

void Draft::take_preset(const std::string& name, const Place& place) {
  std::vector<AssetInfo> materials = list_materials();
  std::vector<std::string_view> names;
  for (const AssetInfo& material : materials) {
    names.push_back(material.name);
    if (material.name != name) continue;
    const std::string file = material.file.string();
    const toml::table table = parse_toml(read_toml_file(material.file), file);
    scene.material = {};
    preset_directions_.clear();
    for (const auto& [key, node] : in_file_order(table)) {
      if (*key == "title" || *key == "source") continue;
      const Place line = fmt::format("{}:{}", file, key->source().begin.line);
      if (*key == "preset")
        throw error(Exit::usage, "{}: a material cannot name another; write its keys", line);
      set({"material"}, key->str(), *node, line);
    }
    for (const char* key : {"membrane_warp", "membrane_weft", "bend_warp", "bend_weft"})
      if (table.contains(key)) preset_directions_.insert(key);
    scene.material.preset = name;
    return;
  }
  throw error(Exit::usage, "{}: material.preset is {}; it must be a name in assets/materials: {}", place,
              in_quotes(name), suggestion(name, names));
}

}  // namespace weft
