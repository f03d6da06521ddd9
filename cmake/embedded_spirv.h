// The table of shader modules built into the program; ends with a null name.
#pragma once
#include <cstddef>
#include <cstdint>

namespace weft::gpu {
struct EmbeddedSpirv {
  const char* name;  // path below shaders/
  const std::uint32_t* words;
  std::size_t count;
};
const EmbeddedSpirv* embedded_spirv();
}  // namespace weft::gpu
