// Contact with spheres and the floor after a drift, operation by operation as docs/float-form.md "Contact".
#pragma once
#include <algorithm>
#include <cmath>

#include "passes/coefficients.h"

namespace weft {

template <class T>
T dot3(const glm::vec<3, T>& a, const glm::vec<3, T>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// The velocity after touching a surface of velocity U and unit normal n: no approach, Coulomb friction.
template <class T>
glm::vec<3, T> respond(const glm::vec<3, T>& v, const glm::vec<3, T>& surface, const glm::vec<3, T>& n,
                       T friction) {
  const glm::vec<3, T> relative = v - surface;
  const T approach = dot3(relative, n);
  if (approach >= T(0)) return v;
  const glm::vec<3, T> tangential = relative - approach * n;
  const T speed = std::sqrt(dot3(tangential, tangential));
  const T cut = friction * (-approach);
  const T keep = speed > cut ? T(1) - cut / speed : T(0);
  return surface + keep * tangential;
}

/// Where a path meets a sphere, relative to its centre at the drift's end.
enum class SphereMeeting { none, ends_inside, enters_deep };

/// @param point  from which the contact normal points: where the path entered, when it went deep; else its
/// end
template <class T>
SphereMeeting meet_sphere(const SphereRow<T>& sphere, const glm::vec<3, T>& p0, const glm::vec<3, T>& p1,
                          glm::vec<3, T>& point) {
  const glm::vec<3, T> path = p1 - p0;
  const T depth = static_cast<T>(0.99) * sphere.reach, depth2 = depth * depth;
  const T a = dot3(path, path), b = dot3(p0, path), c0 = dot3(p0, p0), c1 = dot3(p1, p1);
  const bool deep = dot3(p1, path) > T(0) ? c0 - (b * b) / a < depth2 : c1 < depth2;
  if (!(b < T(0) && c0 >= depth2 && deep)) {
    point = p1;
    return c1 < sphere.reach * sphere.reach ? SphereMeeting::ends_inside : SphereMeeting::none;
  }
  const T k = b * b - a * (c0 - sphere.reach * sphere.reach);
  const T tau = std::max((-b - std::sqrt(std::max(k, T(0)))) / a, T(0));
  point = p0 + tau * path;
  return SphereMeeting::enters_deep;
}

template <class T>
void sphere_contact(const SphereRow<T>& sphere, const glm::vec<3, T>& x0, glm::vec<3, T>& x1,
                    glm::vec<3, T>& v) {
  const glm::vec<3, T> p0 = x0 - (sphere.center - sphere.travel);
  const glm::vec<3, T> p1 = x1 - sphere.center;
  glm::vec<3, T> point;
  const SphereMeeting meeting = meet_sphere(sphere, p0, p1, point);
  if (meeting == SphereMeeting::none) return;
  const T l = std::sqrt(dot3(point, point));
  const glm::vec<3, T> n =
      l > static_cast<T>(shared::kNoLength) ? point * (T(1) / l) : glm::vec<3, T>(T(0), T(1), T(0));
  glm::vec<3, T> surface = sphere.reach * n;
  // From where it entered the path goes on along the tangent plane, as its velocity does: put back there, it
  // would gain speed from what pulls it along the sphere, and never move.
  if (meeting == SphereMeeting::enters_deep) surface = p1 - dot3(p1 - surface, n) * n;
  x1 = sphere.center + surface;
  v = respond(v, sphere.velocity, n, sphere.friction);
}

/// The floor, half the cloth's thickness included.
template <class T>
struct FloorRow {
  T height, friction;
};

template <class T>
void floor_contact(const FloorRow<T>& floor, glm::vec<3, T>& x1, glm::vec<3, T>& v) {
  if (!(x1.y < floor.height)) return;
  x1.y = floor.height;
  v = respond(v, glm::vec<3, T>(T(0)), glm::vec<3, T>(T(0), T(1), T(0)), floor.friction);
}

/// The floor of a scene that has one.
template <class T>
FloorRow<T> floor_row(const Model& model) {
  return {static_cast<T>(model.scene.floor->height_m + model.half_thickness_m),
          static_cast<T>(model.scene.floor->friction)};
}

}  // namespace weft
