// Capsules and boxes as one kind of thing: a box rounded by a radius, in a frame that moves and turns. A
// capsule is a rounded box without width and depth.
#pragma once
#include <glm/mat3x3.hpp>
#include <vector>

#include "scene/scene.h"

namespace weft {

/// Where a body is: world = center + axes·own.
struct SolidFrame {
  glm::dvec3 center_m;
  glm::dmat3 axes;  ///< its columns are the body's own axes in the world
};

/// One body of a scene, which must outlive it.
struct Solid {
  const SolidSection* section;
  SolidFrame start;     ///< without keys and velocity
  glm::dvec3 half_m;    ///< half edges of the box inside the rounding
  double radius_m = 0;  ///< of the rounding
};

/// The scene's capsules, then its boxes, each in the order of the file.
std::vector<Solid> solids_of(const Scene& scene);

/// Where a body is at time t: its keys, or steadily along its velocity.
SolidFrame frame_at(const Solid& solid, double time_s);
SolidFrame frame_at(const SolidSection& section, const SolidFrame& start, double time_s);

/// Turned by angles [°] about the world's x, then y, then z.
glm::dmat3 rotation_matrix(const glm::dvec3& angles_deg);

/// Mean angular velocity [rad/s] that turns `from` into `to`; the shorter way round.
glm::dvec3 angular_velocity(const SolidFrame& from, const SolidFrame& to, double duration_s);

/// Distance [m] of a point from the body's surface, negative inside.
double distance_from(const Solid& solid, const SolidFrame& frame, const glm::dvec3& point_m);

/// Distance [m] from the middle to the farthest point.
double extent_m(const Solid& solid);

/// The largest speed [m/s] of any point within `extent_m` of the middle.
double fastest_m_s(const SolidSection& section, double extent_m);

/// A point of the floor, and its unit normal.
struct FloorPlane {
  glm::dvec3 point_m, normal;
  double above_m(const glm::dvec3& x) const;  ///< height over it along the normal
};
FloorPlane floor_plane(const FloorSection& floor);

}  // namespace weft
