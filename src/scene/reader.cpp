// Reads scene files: syntax, sections, items and keys, in that order; then overrides, then checks.
#include "scene/reader.h"

#include "core/error.h"
#include "core/text.h"
#include "scene/settings.h"

namespace weft {
namespace fs = std::filesystem;
namespace {

Place line_of(const toml::source_region& region, const std::string& name) {
  return fmt::format("{}:{}", name, region.begin.line);
}

class FileReader {
 public:
  FileReader(Draft& draft, const std::string& name) : draft_(draft), name_(name) {}

  void read(const toml::table& root) {
    for (const auto& [key, node] : in_file_order(root)) read_root_key(*key, *node);
    if (!root.contains("cloth"))
      throw error(Exit::usage, "{}: there is no [cloth]; a scene needs one (add the line [cloth])", name_);
  }

 private:
  void read_root_key(const toml::key& key, const toml::node& node) {
    const Place place = line_of(key.source(), name_);
    if (find_parameter("", key.str()) != nullptr) return draft_.set({""}, key.str(), node, place);
    for (const std::string_view section : section_names())
      if (section == key.str()) return read_section(section, node, place);
    std::vector<std::string_view> known{"title"};
    known.insert(known.end(), section_names().begin(), section_names().end());
    throw error(Exit::usage, "{}: {} is not a section of a scene; {}", place, in_quotes(key.str()),
                suggestion(key.str(), known));
  }

  void read_section(std::string_view section, const toml::node& node, const Place& place) {
    if (is_list_section(section)) return read_items(section, node, place);
    const toml::table* table = node.as_table();
    if (table == nullptr)
      throw error(Exit::usage, "{}: {} is {}; it must be a section, written [{}]", place, section,
                  node.is_array_of_tables() ? "a list of sections" : node_text(node), section);
    add_section(draft_.scene, section);
    read_keys({section}, *table, place);
  }

  void read_items(std::string_view section, const toml::node& node, const Place& place) {
    const toml::array* items = node.as_array();
    const bool are_tables = items != nullptr && (items->empty() || items->is_homogeneous<toml::table>());
    if (!are_tables)
      throw error(Exit::usage, "{}: {} is {}; it must be a list of sections, each written [[{}]]", place,
                  section, node_text(node), section);
    for (std::size_t item = 0; item < items->size(); ++item) {
      const toml::node& entry = *items->get(item);
      add_section(draft_.scene, section);
      read_keys({section, item}, *entry.as_table(), line_of(entry.source(), name_));
    }
  }

  void read_keys(const Target& target, const toml::table& table, const Place& place) {
    draft_.note_section(target, place);
    const toml::node* preset = target.section == "material" ? table.get("preset") : nullptr;
    if (preset != nullptr && preset->is_string())  // before the keys that override it
      draft_.take_preset(preset->as_string()->get(), line_of(preset->source(), name_));
    for (const auto& [key, node] : in_file_order(table))
      draft_.set(target, key->str(), *node, line_of(key->source(), name_));
  }

  Draft& draft_;
  const std::string& name_;
};

}  // namespace

LoadedScene parse_scene(std::string_view text, const std::string& name, const SceneOverrides& overrides) {
  Draft draft;
  draft.scene.source = name;
  FileReader(draft, name).read(parse_toml(text, name));
  for (const std::string& override_text : overrides.set)
    if (const auto preset = preset_override(override_text))
      draft.take_preset(*preset, "--set " + override_text);
  for (const std::string& override_text : overrides.set) apply_override(draft, override_text);
  if (draft.scene.title.empty()) draft.scene.title = fs::path(name).stem().string();
  check_scene(draft);
  return {draft.scene, scene_warnings(draft)};
}

LoadedScene load_scene(const fs::path& file, const SceneOverrides& overrides) {
  return parse_scene(read_toml_file(file), file.string(), overrides);
}

}  // namespace weft
