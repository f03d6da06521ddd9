// Any effect of scene/effects.h made hard, without knowing which it is.
#pragma once
#include <string_view>

#include "scene/scene.h"

namespace weft::hard {

/// The scene with an effect, its cloth a little above where effects put what nothing touches.
Scene above_effect(Scene scene, std::string_view effect);

/// The scene with every number of an effect elsewhere on its slider, each at a pace of its own; what says
/// where something is stays.
/// @param k  counts the frames
Scene with_swept_effect(Scene scene, std::string_view effect, std::uint64_t k);

}  // namespace weft::hard
