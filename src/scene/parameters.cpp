// Looking up parameters and sections, and saying a parameter's rule in words.
#include "scene/parameters.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "core/text.h"
#include "scene/motion_keys.h"

namespace weft {
namespace {

constexpr std::string_view kSections[] = {"cloth",    "cloths", "material",     "pins",           "gravity",
                                          "air",      "wind",   "aerodynamics", "floor",          "spheres",
                                          "capsules", "boxes",  "meshes",       "self_collision", "tethers",
                                          "tearing",  "solver", "expect"};

/// Applies `act` to the optional or list that stands for a section; nothing for sections that always stand.
template <class AnyScene, class Act>
void with_section(AnyScene& scene, std::string_view section, Act&& act) {
  if (section == "cloths") return act(scene.cloths);
  if (section == "pins") return act(scene.pins);
  if (section == "spheres") return act(scene.spheres);
  if (section == "capsules") return act(scene.capsules);
  if (section == "boxes") return act(scene.boxes);
  if (section == "meshes") return act(scene.meshes);
  if (section == "aerodynamics") return act(scene.aerodynamics);
  if (section == "gravity") return act(scene.gravity);
  if (section == "air") return act(scene.air);
  if (section == "wind") return act(scene.wind);
  if (section == "floor") return act(scene.floor);
  if (section == "self_collision") return act(scene.self_collision);
  if (section == "tethers") return act(scene.tethers);
  if (section == "tearing") return act(scene.tearing);
  if (section == "expect") return act(scene.expect);
}

template <class T>
std::size_t count_of(const std::optional<T>& section) {
  return section.has_value() ? 1 : 0;
}
template <class T>
std::size_t count_of(const std::vector<T>& section) {
  return section.size();
}

template <class T>
void add_to(std::optional<T>& section) {
  if (!section) section.emplace();
}
template <class T>
void add_to(std::vector<T>& section) {
  section.emplace_back();
}

template <class T>
void clear(std::optional<T>& section) {
  section.reset();
}
template <class T>
void clear(std::vector<T>& section) {
  section.clear();
}

/// "meshes.2.file" → {2, ".file"} where the section is meshes; nothing for what is not of it.
struct ItemKey {
  std::size_t item;
  std::string_view rest;
};
std::optional<ItemKey> item_key(std::string_view id, std::string_view section) {
  if (!id.starts_with(section) || id.size() < section.size() + 2 || id[section.size()] != '.')
    return std::nullopt;
  const char* const first = id.data() + section.size() + 1;
  const char* const last = id.data() + id.size();
  std::size_t item = 0;
  const auto [end, failure] = std::from_chars(first, last, item);
  if (failure != std::errc()) return std::nullopt;
  return ItemKey{item, std::string_view(end, static_cast<std::size_t>(last - end))};
}

/// Items after the one that went move up, and so do the places of their keys.
void forget_item(Places& places, std::string_view section, std::size_t gone) {
  Places kept;
  for (const auto& [id, place] : places) {
    const auto key = item_key(id, section);
    if (!key || key->item < gone)
      kept.emplace(id, place);
    else if (key->item > gone)
      kept.emplace(fmt::format("{}.{}{}", section, key->item - 1, key->rest), place);
  }
  places = std::move(kept);
}

void forget_section(Places& places, std::string_view section) {
  std::erase_if(places, [&](const auto& entry) {
    const std::string_view id = entry.first;
    return id.starts_with(section) && (id.size() == section.size() || id[section.size()] == '.');
  });
}

std::string words_text(std::string_view words) {
  std::string text;
  std::size_t start = 0;
  while (start <= words.size()) {
    const std::size_t bar = std::min(words.find('|', start), words.size());
    if (!text.empty()) text += bar == words.size() ? " or " : ", ";
    text += in_quotes(words.substr(start, bar - start));
    start = bar + 1;
  }
  return text;
}

bool is_listed(std::string_view words, std::string_view word) {
  if (words.empty()) return true;
  return !word.empty() && word.find('|') == std::string_view::npos &&
         fmt::format("|{}|", words).find(fmt::format("|{}|", word)) != std::string::npos;
}

std::string range_text(const Parameter& p) {
  return fmt::format("{} to {}", short_number(p.minimum), short_number(p.maximum));
}

bool in_range(const Parameter& p, double value) {
  return value >= p.minimum && value <= p.maximum;  // false for NaN
}

/// One line that every terminal shows: no control characters, neither ASCII's nor Unicode's (U+0080 to
/// U+009F).
bool is_printable(std::string_view text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if (byte < 0x20 || byte == 0x7F) return false;
    if (byte == 0xC2 && k + 1 < text.size() && static_cast<unsigned char>(text[k + 1]) < 0xA0) return false;
  }
  return true;
}

bool is_allowed(const Parameter& p, const ParameterValue& value) {
  using enum ParameterKind;
  if (const auto* text = std::get_if<std::string>(&value))
    return (p.kind == word || !p.words.empty()) && is_listed(p.words, *text) && is_printable(*text);
  if (const auto* number_value = std::get_if<double>(&value)) {
    if (p.kind != number && p.kind != integer) return false;
    return in_range(p, *number_value) && (p.kind != integer || *number_value == std::floor(*number_value));
  }
  if (const auto* two = std::get_if<glm::dvec2>(&value))
    return p.kind == vec2 && in_range(p, two->x) && in_range(p, two->y);
  if (const auto* motion = std::get_if<MotionKeys>(&value))
    return p.kind == keys && (motion->empty() || broken_motion(p, *motion).empty());
  const auto& three = std::get<glm::dvec3>(value);
  return p.kind == vec3 && in_range(p, three.x) && in_range(p, three.y) && in_range(p, three.z);
}

}  // namespace

const Parameter* find_parameter(std::string_view section, std::string_view key) {
  for (const Parameter& parameter : parameters())
    if (parameter.section == section && parameter.key == key) return &parameter;
  return nullptr;
}

std::span<const std::string_view> section_names() { return kSections; }

bool is_list_section(std::string_view section) {
  bool is_list = false;
  const Scene scene;
  with_section(scene, section, [&](const auto& part) {
    is_list = requires { part[0]; };
  });
  return is_list;
}

void remove_item(Scene& scene, std::string_view section, std::size_t item) {
  with_section(scene, section, [&](auto& part) {
    if constexpr (requires { part[0]; }) part.erase(part.begin() + static_cast<std::ptrdiff_t>(item));
  });
  forget_item(scene.places, section, item);
}

std::size_t item_count(const Scene& scene, std::string_view section) {
  std::size_t count = 1;
  with_section(scene, section, [&](const auto& part) { count = count_of(part); });
  return count;
}

bool has_section(const Scene& scene, std::string_view section) { return item_count(scene, section) > 0; }

void add_section(Scene& scene, std::string_view section) {
  with_section(scene, section, [](auto& part) { add_to(part); });
}

void remove_section(Scene& scene, std::string_view section) {
  with_section(scene, section, [](auto& part) { clear(part); });
  forget_section(scene.places, section);
}

std::string value_text(const ParameterValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return in_quotes(*text);
  if (const auto* number = std::get_if<double>(&value)) return short_number(*number);
  if (const auto* two = std::get_if<glm::dvec2>(&value))
    return fmt::format("[{}, {}]", short_number(two->x), short_number(two->y));
  if (const auto* motion = std::get_if<MotionKeys>(&value))
    return motion->empty() ? std::string("none") : fmt::format("{} keys", motion->size());
  const auto& three = std::get<glm::dvec3>(value);
  return fmt::format("[{}, {}, {}]", short_number(three.x), short_number(three.y), short_number(three.z));
}

std::string default_text(const Parameter& parameter) {
  if (parameter.required) return "required";
  if (!parameter.default_text.empty()) return std::string(parameter.default_text);
  Scene scene;
  add_section(scene, parameter.section);
  return value_text(parameter.get(scene, 0));
}

std::string rule_text(const Parameter& p) {
  using enum ParameterKind;
  if (p.kind == word)
    return p.words.empty() ? "a word in quotes, printable and on one line" : words_text(p.words);
  if (p.kind == keys)
    return fmt::format("a list of keys {{ time = s, {} = [x, y, z]{} }}", motion_place_name(p),
                       motion_turns(p) ? ", rotation = [x, y, z]" : "");
  std::string text = range_text(p);
  if (p.kind == integer) text += ", a whole number";
  if (p.kind == vec2) text = "two numbers, each " + text;
  if (p.kind == vec3) text = "three numbers, each " + text;
  if (!p.unit.empty()) text += fmt::format(", in {}", p.unit);
  if (!p.words.empty()) text += ", or " + words_text(p.words);
  return text;
}

std::string broken_rule(const Parameter& parameter, const ParameterValue& value) {
  if (is_allowed(parameter, value)) return {};
  return fmt::format("it must be {} ({})", rule_text(parameter), parameter.example);
}

}  // namespace weft
