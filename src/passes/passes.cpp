// The list of passes.
#include "passes/passes.h"

#include <array>

namespace weft {

std::span<const Pass* const> passes() {
  static constexpr std::array kPasses{&integrate, &euler_step, &velocity_verlet_step, &verlet_step, &normals};
  return kPasses;
}

}  // namespace weft
