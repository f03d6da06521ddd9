// An orbit camera, and the place from which a scene looks best when nobody says otherwise.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "model/model.h"

namespace weft {

/// An axis-aligned box [m].
struct Bounds {
  glm::dvec3 low{0.0}, high{0.0};
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  double radius_m() const;  ///< half the diagonal
};

/// Looks at `target_m` from `distance_m` away. Yaw 0 looks along −z, a positive yaw moves the eye towards +x;
/// a positive pitch lifts it.
struct Camera {
  glm::dvec3 target_m{0.0};
  double yaw_rad = 0.0, pitch_rad = 0.0;
  double distance_m = 3.0;
  double fov_y_rad = 0.68;  ///< angle between the top and the bottom of the picture

  glm::dvec3 forward() const;
  glm::dvec3 right() const;
  glm::dvec3 up() const;
  glm::dvec3 eye_m() const;
  double near_m() const;
  /// World to Vulkan clip space; depth is 1 at near_m() and falls to 0 at infinity.
  glm::mat4 clip(double aspect) const;
};

/// As far as cloths slide in a window, which does not know how long it will be looked at.
inline constexpr double kSlideShown_s = 2.0;

/// What is worth seeing of a scene: where the cloth starts, where it will hang or lie, and the spheres.
/// @param film_s  how long it slides on a floor that leans, unless it is pinned
Bounds scene_bounds(const Model& model, double film_s = kSlideShown_s);

/// A three-quarter view that just holds scene_bounds() at width/height = `aspect`.
Camera default_camera(const Model& model, double aspect, double film_s = kSlideShown_s);

}  // namespace weft
