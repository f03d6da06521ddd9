// Frames and distances of capsules and boxes.
#include "model/solids.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "model/motion.h"

namespace weft {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// The frame whose second axis points along `direction`; any direction when there is none.
glm::dmat3 frame_along(const glm::dvec3& direction) {
  const double l = glm::length(direction);
  if (!(l > 0.0)) return glm::dmat3(1.0);
  const glm::dvec3 y = direction / l;
  const glm::dvec3 away = std::abs(y.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
  const glm::dvec3 z = glm::normalize(glm::cross(away, y));
  return {glm::cross(y, z), y, z};
}

}  // namespace

glm::dmat3 rotation_matrix(const glm::dvec3& angles_deg) {
  const glm::dvec3 a = kRadians * angles_deg;
  const double cx = std::cos(a.x), sx = std::sin(a.x), cy = std::cos(a.y), sy = std::sin(a.y);
  const double cz = std::cos(a.z), sz = std::sin(a.z);
  const glm::dmat3 x({1, 0, 0}, {0, cx, sx}, {0, -sx, cx});
  const glm::dmat3 y({cy, 0, -sy}, {0, 1, 0}, {sy, 0, cy});
  const glm::dmat3 z({cz, sz, 0}, {-sz, cz, 0}, {0, 0, 1});
  return z * y * x;
}

std::vector<Solid> solids_of(const Scene& scene) {
  std::vector<Solid> solids;
  for (const CapsuleSection& c : scene.capsules)
    solids.push_back({.section = &c,
                      .start = {0.5 * (c.a_m + c.b_m), frame_along(c.b_m - c.a_m)},
                      .half_m = {0.0, 0.5 * glm::distance(c.a_m, c.b_m), 0.0},
                      .radius_m = c.radius_m});
  for (const BoxSection& box : scene.boxes)
    solids.push_back({.section = &box,
                      .start = {box.center_m, rotation_matrix(box.rotation_deg)},
                      .half_m = 0.5 * box.size_m});
  return solids;
}

SolidFrame frame_at(const SolidSection& section, const SolidFrame& start, double time_s) {
  if (section.keys.empty()) return {start.center_m + time_s * section.velocity_m_s, start.axes};
  return {place_at(section.keys, time_s), rotation_matrix(rotation_at(section.keys, time_s)) * start.axes};
}

SolidFrame frame_at(const Solid& solid, double time_s) {
  return frame_at(*solid.section, solid.start, time_s);
}

glm::dvec3 angular_velocity(const SolidFrame& from, const SolidFrame& to, double duration_s) {
  const glm::dmat3 turn = to.axes * glm::transpose(from.axes);
  // The skew part of a rotation is its axis times the sine of its angle; its trace is 1 + 2·cosine.
  const glm::dvec3 skew =
      0.5 * glm::dvec3(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
  const double sine = glm::length(skew), cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0);
  if (!(sine > 1e-14) || !(duration_s > 0.0)) return glm::dvec3(0.0);
  return skew * (std::atan2(sine, cosine) / (sine * duration_s));
}

double distance_from(const Solid& solid, const SolidFrame& frame, const glm::dvec3& point_m) {
  const glm::dvec3 own = glm::transpose(frame.axes) * (point_m - frame.center_m);
  const glm::dvec3 q = glm::abs(own) - solid.half_m;
  const double inside = std::min(std::max({q.x, q.y, q.z}), 0.0);
  return glm::length(glm::max(q, 0.0)) + inside - solid.radius_m;
}

double extent_m(const Solid& solid) { return glm::length(solid.half_m) + solid.radius_m; }

double fastest_m_s(const SolidSection& section, double extent_m) {
  if (section.keys.empty()) return glm::length(section.velocity_m_s);
  double turning_rad_s = 0.0;
  for (std::size_t k = 1; k < section.keys.size(); ++k) {
    const MotionKey &from = section.keys[k - 1], &to = section.keys[k];
    const glm::dvec3 turn = glm::abs(to.rotation_deg - from.rotation_deg) * kRadians;
    turning_rad_s = std::max(turning_rad_s, (turn.x + turn.y + turn.z) / (to.time_s - from.time_s));
  }
  return fastest_m_s(section.keys) + turning_rad_s * extent_m;
}

double FloorPlane::above_m(const glm::dvec3& x) const { return glm::dot(x - point_m, normal); }

FloorPlane floor_plane(const FloorSection& floor) {
  return {{0.0, floor.height_m, 0.0},
          floor.is_level() ? glm::dvec3(0.0, 1.0, 0.0) : glm::normalize(floor.normal)};
}

}  // namespace weft
