// The list of passes.
#include "passes/passes.h"

#include <array>

namespace weft {

std::span<const Pass* const> passes() {
  static constexpr std::array<const Pass*, 2> kPasses{&integrate, &normals};
  return kPasses;
}

}  // namespace weft
