// What a scene's parts say of each other.
#include "scene/scene.h"

#include <charconv>
#include <string_view>

namespace weft {

std::string place_of(const Scene& scene, std::string_view key) {
  for (std::string_view id = key; !id.empty();) {
    if (const auto found = scene.places.find(id); found != scene.places.end()) return found->second;
    const std::size_t dot = id.rfind('.');
    id = id.substr(0, dot == std::string_view::npos ? 0 : dot);
  }
  return scene.source.empty() ? "scene" : scene.source;
}

ClothSection cloth_of(const Scene& scene, std::size_t index) {
  ClothSection cloth = scene.cloth;
  if (index == 0) return cloth;
  const SheetSection& sheet = scene.cloths.at(index - 1);
  cloth.center_m = sheet.center_m;
  cloth.orientation = sheet.orientation.value_or(cloth.orientation);
  cloth.imperfection_m = sheet.imperfection_m.value_or(cloth.imperfection_m);
  return cloth;
}

std::optional<std::size_t> attached_sphere(const Scene& scene, const PinSection& pin) {
  constexpr std::string_view kList = "spheres.";
  if (!pin.attach.starts_with(kList)) return std::nullopt;
  const char* const first = pin.attach.data() + kList.size();
  const char* const last = pin.attach.data() + pin.attach.size();
  std::size_t index = 0;
  const auto [end, failure] = std::from_chars(first, last, index);
  if (failure != std::errc() || end != last || index >= scene.spheres.size()) return std::nullopt;
  return index;
}

}  // namespace weft
