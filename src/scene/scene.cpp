// What a scene's parts say of each other.
#include "scene/scene.h"

#include <charconv>
#include <string_view>

namespace weft {

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
