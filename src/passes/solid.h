// Contact with capsules, boxes and a tilted floor, operation by operation as docs/float-form.md "Capsules and
// boxes".
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "passes/contact.h"

namespace weft {

/// Distance from the surface [m], negative inside, and its gradient: a unit vector out of the body.
template <class T>
struct SolidNear {
  T distance;
  glm::vec<3, T> normal;
};

/// Of a point in the body's own frame.
template <class T>
SolidNear<T> near_solid(const SolidRow<T>& solid, const glm::vec<3, T>& p) {
  glm::vec<3, T> q, over, side;
  for (int k = 0; k < 3; ++k) {
    q[k] = std::abs(p[k]) - solid.half[k];
    over[k] = std::max(q[k], T(0));
    side[k] = p[k] < T(0) ? T(-1) : T(1);
  }
  const T l = std::sqrt(dot3(over, over));
  if (l > static_cast<T>(shared::kNoLength)) return {l - solid.reach, side * (over * (T(1) / l))};
  const int axis = q.x >= q.y && q.x >= q.z ? 0 : (q.y >= q.z ? 1 : 2);
  glm::vec<3, T> normal(T(0));
  normal[axis] = side[axis];
  return {q[axis] - solid.reach, normal};
}

/// Newton's method for the place t on p0 + t·way where the distance falls to `level`, from t = 0 on.
/// @return whether it does before t = 1; t is where the search ended
template <class T>
bool falls_to(const SolidRow<T>& solid, T level, const glm::vec<3, T>& p0, const glm::vec<3, T>& way, T& t) {
  t = T(0);
  for (std::uint32_t k = 0; k < shared::kSolidNewtonSteps; ++k) {
    const SolidNear<T> here = near_solid(solid, p0 + t * way);
    const T above = here.distance - level;
    if (above <= T(0.25) * solid.deep) return true;
    const T slope = dot3(here.normal, way);
    if (slope >= T(0)) return false;
    t = t - above / slope;
    if (t > T(1)) return false;
  }
  return false;
}

/// Whether the path p0 → p1 came from outside and went deep, and where it entered.
template <class T>
bool enters_deep(const SolidRow<T>& solid, const glm::vec<3, T>& p0, const glm::vec<3, T>& p1,
                 glm::vec<3, T>& entry) {
  const glm::vec<3, T> way = p1 - p0;
  const T squared = dot3(way, way);
  if (!(squared > solid.deep * solid.deep)) return false;
  const T outside = near_solid(solid, p0).distance;
  if (outside < -solid.deep || (outside > T(0) && outside * outside > squared)) return false;
  T t;
  if (!falls_to(solid, -solid.deep, p0, way, t)) return false;
  falls_to(solid, T(0), p0, way, t);
  entry = p0 + t * way;
  return true;
}

/// From where a path entered it goes on along the surface: its end is moved onto the tangent plane, behind
/// which the whole of a convex body lies. Were it put back to where it entered, a velocity along the surface
/// would take it nowhere, and what pulls it there would add to that velocity for ever.
/// @param point  where the path entered, then where it ends; `near` is of that, at distance 0
/// @return       false where the path leads out at `point`, so that nothing stops it
template <class T>
bool slides_on(const SolidRow<T>& solid, const glm::vec<3, T>& p1, glm::vec<3, T>& point,
               SolidNear<T>& near) {
  near = near_solid(solid, point);
  const glm::vec<3, T> surface = point - near.distance * near.normal;
  const T rise = dot3(p1 - surface, near.normal);
  if (!(rise < T(0))) return false;
  point = p1 - rise * near.normal;
  near.distance = T(0);
  return true;
}

template <class T>
glm::vec<3, T> in_frame(const glm::vec<3, T> (&axes)[3], const glm::vec<3, T>& r) {
  return {dot3(axes[0], r), dot3(axes[1], r), dot3(axes[2], r)};
}

template <class T>
glm::vec<3, T> in_world(const glm::vec<3, T> (&axes)[3], const glm::vec<3, T>& p) {
  return (p.x * axes[0] + p.y * axes[1]) + p.z * axes[2];
}

/// Each component as product minus product.
template <class T>
glm::vec<3, T> cross3(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
void solid_touch(const SolidRow<T>& solid, const glm::vec<3, T>& x0, glm::vec<3, T>& x1, glm::vec<3, T>& v) {
  const glm::vec<3, T> p0 = in_frame(solid.start_axes, x0 - solid.start);
  const glm::vec<3, T> p1 = in_frame(solid.axes, x1 - solid.center);
  glm::vec<3, T> point = p1;
  SolidNear<T> near;
  const bool stopped = enters_deep(solid, p0, p1, point) && slides_on(solid, p1, point, near);
  if (!stopped) {
    point = p1;
    near = near_solid(solid, p1);
    if (!(near.distance < T(0))) return;
  }
  const glm::vec<3, T> arm = in_world(solid.axes, point - near.distance * near.normal);
  x1 = solid.center + arm;
  v = respond(v, solid.velocity + cross3(solid.spin, arm), in_world(solid.axes, near.normal), solid.friction);
}

/// @param friction  of the floor
template <class T>
void tilted_touch(const TiltRow<T>& floor, T friction, glm::vec<3, T>& x1, glm::vec<3, T>& v) {
  const T above = dot3(floor.normal, x1) - floor.level;
  if (!(above < T(0))) return;
  x1 = x1 - above * floor.normal;
  v = respond(v, glm::vec<3, T>(T(0)), floor.normal, friction);
}

}  // namespace weft
