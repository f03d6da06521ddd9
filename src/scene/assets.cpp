// The assets that come with the program: where they are, and finding a scene by number, name or path.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <system_error>

#include "core/error.h"
#include "core/text.h"
#include "scene/reader.h"
#include "scene/settings.h"

namespace weft {
namespace fs = std::filesystem;
namespace {

bool holds_assets(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "scenes", ignored) && fs::is_directory(folder / "materials", ignored);
}

/// "1-two-corners" → "two-corners".
std::string without_number(const std::string& stem) {
  const auto dash = stem.find('-');
  const bool numbered = dash != std::string::npos && dash > 0 &&
                        std::all_of(stem.begin(), stem.begin() + static_cast<std::ptrdiff_t>(dash),
                                    [](unsigned char c) { return std::isdigit(c) != 0; });
  return numbered ? stem.substr(dash + 1) : stem;
}

std::string number_of(const std::string& stem) {
  const std::string name = without_number(stem);
  return name.size() == stem.size() ? std::string() : stem.substr(0, stem.size() - name.size() - 1);
}

/// The title a file gives itself; empty when it cannot be read, since a list must not fail for one bad file.
std::string title_of(const fs::path& file) {
  try {
    return parse_toml(read_toml_file(file), file.string())["title"].value_or(std::string());
  } catch (const Error&) {
    return {};
  }
}

std::vector<AssetInfo> list_assets(const char* kind) {
  std::vector<AssetInfo> assets;
  for (const auto& entry : fs::directory_iterator(assets_dir() / kind))
    if (entry.path().extension() == ".toml")
      assets.push_back({entry.path().stem().string(), title_of(entry.path()), entry.path()});
  std::sort(assets.begin(), assets.end(),
            [](const AssetInfo& a, const AssetInfo& b) { return a.name < b.name; });
  return assets;
}

}  // namespace

fs::path assets_dir() {
  if (const char* chosen = std::getenv("WEFT_ASSETS"); chosen != nullptr && *chosen != '\0') {
    if (holds_assets(chosen)) return chosen;
    throw error(Exit::usage, "WEFT_ASSETS is {}; it must be a folder that holds scenes and materials",
                in_quotes(chosen, 200));
  }
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path source_tree = fs::path(__FILE__).parent_path().parent_path().parent_path();
  for (const fs::path& folder :
       {program / "assets", program.parent_path() / "share" / "weft" / "assets", source_tree / "assets"})
    if (holds_assets(folder)) return folder;
  throw error(Exit::usage, "the assets folder is not beside the program; set WEFT_ASSETS to it");
}

std::vector<AssetInfo> list_scenes() { return list_assets("scenes"); }

std::vector<AssetInfo> numbered_scenes() {
  std::vector<AssetInfo> scenes = list_scenes();
  std::erase_if(scenes, [](const AssetInfo& scene) { return number_of(scene.name).empty(); });
  return scenes;
}

std::vector<AssetInfo> list_materials() { return list_assets("materials"); }

fs::path find_scene(const std::string& wanted) {
  const std::vector<AssetInfo> scenes = list_scenes();
  for (const AssetInfo& scene : scenes)
    if (!wanted.empty() &&
        (wanted == scene.name || wanted == without_number(scene.name) || wanted == number_of(scene.name)))
      return scene.file;
  std::error_code ignored;
  if (!wanted.empty() && fs::exists(wanted, ignored)) return wanted;

  std::vector<std::string> names;
  names.reserve(scenes.size());
  for (const AssetInfo& scene : scenes) names.push_back(without_number(scene.name));
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw error(Exit::usage, "there is no scene or file {}; a scene is a number 1 to {}, a path, or a name: {}",
              in_quotes(wanted, 200), numbered_scenes().size(), suggestion(wanted, known));
}

}  // namespace weft
