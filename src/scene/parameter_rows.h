// The parts that the parameter table is put together from. Internal to src/scene.
#pragma once
#include <span>

#include "scene/parameters.h"

namespace weft::parameter_access {

// Ranges are as wide as the solvers are tested for, and no wider: a value outside is a slip of the keyboard
// or of the unit. 1e4 m keeps a float's last bit below a millimetre.
inline constexpr double kFarthest_m = 1e4;

/// In the order of docs/scene-format.md, one part after the other.
std::span<const Parameter> cloth_rows();
std::span<const Parameter> outside_rows();
std::span<const Parameter> collider_rows();
std::span<const Parameter> run_rows();

}  // namespace weft::parameter_access
