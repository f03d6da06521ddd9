// The parts that the list of hard cases is put together from.
#pragma once
#include <vector>

#include "support/hard_cases.h"

namespace weft::hard {

std::vector<HardCase> body_cases();     ///< capsules, boxes, meshes, a tilted floor
std::vector<HardCase> holding_cases();  ///< air, limits, tearing, tethers, pins that ride and let go
std::vector<HardCase> effect_cases();   ///< one for each row of scene/effects.h, by itself

}  // namespace weft::hard
