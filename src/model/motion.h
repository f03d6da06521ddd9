// Scripted motion: where something is between its keys.
#pragma once
#include "scene/scene.h"

namespace weft {

/// Piecewise linear between the keys, held before the first and after the last [m].
/// @param keys  at least one, times ascending
glm::dvec3 place_at(const MotionKeys& keys, double time_s);

/// The angles of `keys` [°], each piecewise linear and held likewise.
glm::dvec3 rotation_at(const MotionKeys& keys, double time_s);

/// The slope between the keys that led to this moment [m/s]; 0 up to the first key and after the last.
glm::dvec3 velocity_before(const MotionKeys& keys, double time_s);

/// The largest speed between two keys [m/s]; 0 without keys.
double fastest_m_s(const MotionKeys& keys);

}  // namespace weft
