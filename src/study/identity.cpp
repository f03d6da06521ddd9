// The canonical words of a scene come from the one table of parameters, so that a new key is never forgotten.
#include "study/identity.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/cache.h"
#include "scene/parameters.h"

namespace weft::study {
namespace {

struct ExactText {
  std::string operator()(double v) const { return fmt::format("{:.17g}", v == 0.0 ? 0.0 : v); }
  std::string operator()(const glm::dvec2& v) const { return (*this)(v.x) + "," + (*this)(v.y); }
  std::string operator()(const glm::dvec3& v) const {
    return (*this)(v.x) + "," + (*this)(v.y) + "," + (*this)(v.z);
  }
  std::string operator()(const std::string& v) const { return v; }
  std::string operator()(const MotionKeys& keys) const {
    std::string text;
    for (const MotionKey& key : keys) {
      text += fmt::format("{}:{}", (*this)(key.time_s), (*this)(key.place_m));
      if (key.rotation_deg != glm::dvec3(0.0)) text += fmt::format("@{}", (*this)(key.rotation_deg));
      text += ';';
    }
    return text;
  }
};

/// Whether the motion depends on a key, whatever solver runs.
bool moves_the_cloth(const Parameter& row) {
  if (row.section == "solver") return row.key == "frame";
  return !row.section.empty() && row.section != "expect" && row.key != "preset";
}

/// The value with which a key says that its effect is not there; scenes without it keep the words they had
/// before the key came.
std::optional<ParameterValue> absent_value(const Scene& scene, const Parameter& row) {
  if (row.kind == ParameterKind::keys) return MotionKeys{};
  if (row.section == "material" && row.key == "strain_limit") return 0.0;
  if (row.key == "attach") return std::string();
  if (row.section == "pins" && row.key == "cloth") return 0.0;
  if (row.key.starts_with("membrane_")) return scene.material.membrane_n_m;
  if (row.key.starts_with("bend_")) return scene.material.bend_n_m;
  return std::nullopt;
}

}  // namespace

std::string canonical_scene(const Scene& scene) {
  std::string text;
  for (const Parameter& row : parameters()) {
    if (!moves_the_cloth(row) || !has_section(scene, row.section)) continue;
    for (std::size_t item = 0; item < item_count(scene, row.section); ++item) {
      const ParameterValue value = row.get(scene, item);
      const double* number = std::get_if<double>(&value);
      if (value == absent_value(scene, row) || (number != nullptr && std::isnan(*number))) continue;
      text += fmt::format("{}.{}.{}={}\n", row.section, item, row.key, std::visit(ExactText{}, value));
    }
  }
  return text;
}

std::uint64_t hash_of(std::string_view bytes) { return fnv1a_64(bytes); }

std::string name_of(std::string_view bytes) { return fmt::format("{:016x}", hash_of(bytes)); }

bool make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  return std::filesystem::is_directory(folder, failure);
}

}  // namespace weft::study
