// A finished picture on the host.
#pragma once
#include <cstdint>
#include <vector>

namespace weft {

/// Rows from the top, four bytes a pixel: red, green, blue (sRGB) and 255.
struct Picture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< shape [height · width · 4]
};

}  // namespace weft
