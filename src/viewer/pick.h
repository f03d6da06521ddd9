// The pointer's ray against the cloth and the plane a hand moves in.
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "model/model.h"
#include "render/camera.h"

namespace weft {

struct Ray {
  glm::dvec3 origin{0.0}, direction{0.0};  ///< [m]; direction of length 1
};

/// The ray from the camera's eye through a point of the picture.
/// @param point  0..1 across the picture, (0,0) its top-left corner
Ray camera_ray(const Camera& camera, double aspect, glm::dvec2 point);

struct Pick {
  std::uint32_t particle = 0;  ///< the nearest corner of the triangle hit
  glm::dvec3 point{0.0};       ///< [m]
  double distance_m = 0.0;     ///< along the ray
};

/// The first cloth triangle on the ray, from either side. Checks every triangle: meant for a click.
std::optional<Pick> pick_cloth(const Grid& grid, const State& state, const Ray& ray);

/// Where the ray meets the plane through `point` with `normal`; nothing when it runs along or away.
std::optional<glm::dvec3> meet_plane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal);

}  // namespace weft
