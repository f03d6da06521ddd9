// `--set section.key=value`: one TOML value on top of the file, by the same table and the same checks.
#include <algorithm>
#include <charconv>

#include "core/error.h"
#include "core/text.h"
#include "scene/settings.h"

namespace weft {
namespace {

struct Override {
  Place place;
  std::string path;   ///< before the first '='
  std::string value;  ///< after it
};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Place place_of_override(const std::string& text) {
  const std::string shown = in_quotes(text, 80);
  return "--set " + shown.substr(1, shown.size() - 2);
}

Override split(const std::string& text) {
  Override result{place_of_override(text), {}, {}};
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    throw error(Exit::usage, "{}: there is no '='; write section.key=value, such as material.density=0.3",
                result.place);
  result.path = trimmed(std::string_view(text).substr(0, equals));
  result.value = trimmed(std::string_view(text).substr(equals + 1));
  return result;
}

/// The value as TOML. A bare word where the key takes a word is that word, since shells eat the quotes.
toml::table parsed_value(const Override& change, const Parameter* parameter) {
  try {
    toml::table table = parse_toml("value = " + change.value, change.place);
    if (table.size() == 1) return table;
  } catch (const Error&) {
    const bool takes_word =
        parameter != nullptr && (parameter->kind == ParameterKind::word || !parameter->words.empty());
    const bool is_bare = change.value.find_first_of("\"'\\\n\r[]{}#=") == std::string::npos;
    if (takes_word && is_bare && !change.value.empty()) return toml::table{{"value", change.value}};
  }
  throw error(Exit::usage, "{}: {} is not a TOML value; write a number, [1, 2, 3], or a word in quotes",
              change.place, in_quotes(change.value));
}

/// Adds the item when the list has just so many.
void reach_item(Draft& draft, const Override& change, const Target& target) {
  if (target.item < item_count(draft.scene, target.section)) return;
  add_section(draft.scene, target.section);
  draft.note_section(target, change.place);
}

void set_keys(Draft& draft, const Override& change, const Target& target, const toml::table& keys) {
  for (const auto& [key, node] : keys) draft.set(target, key.str(), node, change.place);
}

/// "spheres.1.radius" → item 1, "spheres.1" too, and `key` what is left; appended when the list has one item
/// so far.
Target list_target(Draft& draft, const Override& change, std::string_view section, std::string_view& key) {
  const auto dot = key.find('.');
  const std::string_view digits = key.substr(0, dot);
  const std::size_t count = item_count(draft.scene, section);
  std::size_t item = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), item);
  if (failure != std::errc{} || end != digits.data() + digits.size())
    throw error(Exit::usage,
                "{}: {} is a list; write {}.0.key=value for its first item, or {}=[{{key=value}}]",
                change.place, section, section, section);
  if (item > count)
    throw error(Exit::usage,
                "{}: {}.{} does not exist; there {} {}, so the index must be 0 to {} ({} adds one)",
                change.place, section, digits, count == 1 ? "is" : "are", count, count, count);
  key = dot == std::string_view::npos ? std::string_view() : key.substr(dot + 1);
  return {section, item};
}

/// "spheres.1={center=[0,1,0], radius=0.2}": several keys of one item.
void apply_item(Draft& draft, const Override& change, const Target& target) {
  const toml::table table = parsed_value(change, nullptr);
  const toml::table* keys = table.get("value")->as_table();
  if (keys == nullptr)
    throw error(Exit::usage, "{}: {} is a list; write {}.{}.key=value, or {}.{}={{key=value}}", change.place,
                target.section, target.section, target.item, target.section, target.item);
  reach_item(draft, change, target);
  set_keys(draft, change, target, *keys);
}

/// "spheres=[{center=[0,1,0], radius=0.2}]": the list anew.
void apply_list(Draft& draft, const Override& change, std::string_view section) {
  const toml::table table = parsed_value(change, nullptr);
  const toml::array* items = table.get("value")->as_array();
  if (items == nullptr || !(items->empty() || items->is_homogeneous<toml::table>()))
    throw error(Exit::usage,
                "{}: {} is a list; write {}.0.key=value for its first item, or {}=[{{key=value}}]",
                change.place, section, section, section);
  remove_section(draft.scene, section);
  for (std::size_t item = 0; item < items->size(); ++item) {
    reach_item(draft, change, {section, item});
    set_keys(draft, change, {section, item}, *items->get(item)->as_table());
  }
}

void apply_to_section(Draft& draft, const Override& change, std::string_view section, std::string_view key) {
  Target target{section};
  if (is_list_section(section)) {
    target = list_target(draft, change, section, key);
    if (key.empty()) return apply_item(draft, change, target);
    reach_item(draft, change, target);
  } else if (!has_section(draft.scene, section)) {
    add_section(draft.scene, section);
    draft.note_section(target, change.place);
  }
  const toml::table table = parsed_value(change, find_parameter(section, key));
  draft.set(target, key, *table.get("value"), change.place);
}

/// "gravity={}" adds a section with its defaults; "floor={height=0}" with some keys.
void apply_table(Draft& draft, const Override& change, std::string_view section) {
  if (is_list_section(section)) return apply_list(draft, change, section);
  const toml::table table = parsed_value(change, nullptr);
  const toml::table* keys = table.get("value")->as_table();
  if (keys == nullptr)
    throw error(Exit::usage, "{}: {} is a section; write {}=value", change.place, section,
                full_key({section}, "key"));
  add_section(draft.scene, section);
  draft.note_section({section}, change.place);
  const toml::node* preset = section == "material" ? keys->get("preset") : nullptr;
  if (preset != nullptr && preset->is_string()) draft.take_preset(preset->as_string()->get(), change.place);
  set_keys(draft, change, {section}, *keys);
}

}  // namespace

std::optional<std::string> preset_override(const std::string& text) {
  const Override change = split(text);
  if (change.path != "material.preset") return std::nullopt;
  const toml::table table = parsed_value(change, find_parameter("material", "preset"));
  return table.get("value")->value<std::string>();
}

void apply_override(Draft& draft, const std::string& text) {
  const Override change = split(text);
  const std::string_view path = change.path;
  const auto dot = path.find('.');
  const std::string_view head = path.substr(0, dot);
  if (dot == std::string_view::npos && find_parameter("", head) != nullptr) {
    const toml::table table = parsed_value(change, find_parameter("", head));
    return draft.set({""}, head, *table.get("value"), change.place);
  }
  for (const std::string_view section : section_names()) {
    if (section != head) continue;
    if (dot == std::string_view::npos) return apply_table(draft, change, section);
    return apply_to_section(draft, change, section, path.substr(dot + 1));
  }
  throw error(Exit::usage, "{}: {} is not a section of a scene; {}", change.place, in_quotes(head),
              suggestion(head, section_names()));
}

}  // namespace weft
