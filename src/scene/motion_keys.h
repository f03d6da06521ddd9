// Keys of a motion in a scene file: `keys = [{ time = 0, center = [0, 1, 0] }, …]`. Internal to src/scene.
#pragma once
#include "scene/settings.h"

namespace weft {

/// Reads a list of keys.
/// @param name   as messages call the list: "spheres.0.keys"
/// @throws Error(Exit::usage) naming the key and what is wrong with it
MotionKeys read_motion(const Parameter&, const std::string& name, const toml::node&, const Place&);

/// What is wrong with the keys, from the index of the key on: "1.time is 0.5; it must be …". Empty when
/// nothing is.
std::string broken_motion(const Parameter&, const MotionKeys&);

}  // namespace weft
