// The orbit camera's axes and matrix; the default framing.
#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "render/solid_mesh.h"

namespace weft {
namespace {

constexpr double kDegree = 0.017453292519943295;
constexpr double kMargin = 1.04;  // air around the scene, as a factor on the distance

void include(Bounds& bounds, const glm::dvec3& low, const glm::dvec3& high) {
  bounds.low = glm::min(bounds.low, low);
  bounds.high = glm::max(bounds.high, high);
}

Bounds start_bounds(const State& start) {
  Bounds bounds{start.position.front(), start.position.front()};
  for (const glm::dvec3& p : start.position) include(bounds, p, p);
  return bounds;
}

glm::dvec2 flat_place(const Model& model, const PinSection& pin) {
  return {pin.at.x * model.grid.width_m(), pin.at.y * model.grid.height_m()};
}

/// The start's height above the world's origin at a pin.
double pin_height_m(const Model& model, const PinSection& pin) {
  const ClothSection cloth = cloth_of(model.scene, pin.cloth);
  if (cloth.orientation == Orientation::horizontal) return cloth.center_m.y;
  return cloth.center_m.y + model.grid.height_m() * (0.5 - pin.at.y);
}

/// How low the cloth's corners hang when the threads from the pins are straight. The middle of a cloth held
/// all around sags by something like a sixth of its size.
double hanging_low_m(const Model& model, std::uint32_t cloth, double start_low_m) {
  const double width = model.grid.width_m(), height = model.grid.height_m();
  const glm::dvec2 corners[] = {{0.0, 0.0}, {width, 0.0}, {0.0, height}, {width, height}};
  double low = start_low_m;
  double sag = std::numeric_limits<double>::infinity();
  for (const glm::dvec2& corner : corners) {
    double held = -std::numeric_limits<double>::infinity();
    for (const PinSection& pin : model.scene.pins)
      if (pin.cloth == cloth)
        held = std::max(held, pin_height_m(model, pin) - glm::distance(flat_place(model, pin), corner));
    low = std::min(low, held);
    sag = std::min(sag, start_low_m - held);
  }
  const bool held_all_around = sag <= 1e-9 && low >= start_low_m - 1e-9;
  return held_all_around ? start_low_m - std::max(width, height) / 6.0 : low;
}

/// How low pins let the cloths hang that they hold; a free one beside them falls to the floor.
double low_with_pins_m(const Model& model, double start_low_m) {
  const Scene& scene = model.scene;
  double low = start_low_m;
  for (std::uint32_t cloth = 0; cloth < model.grid.cloths; ++cloth) {
    const auto holds = [cloth](const PinSection& pin) { return pin.cloth == cloth; };
    if (std::ranges::any_of(scene.pins, holds))
      low = std::min(low, hanging_low_m(model, cloth, start_low_m));
    else if (scene.floor && scene.gravity)
      low = std::min(low, scene.floor->height_m);
  }
  return low;
}

/// A free cloth that falls upright folds over where it lands: about a third of its height to either side, and
/// a seventh of its width beyond its edges.
void include_landing(Bounds& bounds, const Model& model, const ClothSection& cloth) {
  const glm::dvec3& center = cloth.center_m;
  const glm::dvec3 reach{0.65 * model.grid.width_m(), 0.0, 0.35 * model.grid.height_m()};
  const glm::dvec3 middle{center.x, bounds.low.y, center.z};
  include(bounds, middle - reach, middle + reach);
}

/// How far above the floor, along its normal.
double height_above_m(const FloorSection& floor, const glm::dvec3& place) {
  return glm::dot(place - glm::dvec3(0.0, floor.height_m, 0.0), glm::normalize(floor.normal));
}

/// A free cloth falls on a floor that leans and slides down: a point with its weight, drag and friction. It
/// lands edge first and keeps more of its way than a point does: of the landing's friction three quarters are
/// right (scene `slope`: 0.07 m too far after 3 s; with all of it 0.25 m too short).
void include_slide(Bounds& bounds, const Model& model, const ClothSection& cloth, double film_s) {
  const Scene& scene = model.scene;
  const FloorSection& floor = *scene.floor;
  const glm::dvec3 gravity = scene.gravity->acceleration_m_s2, normal = glm::normalize(floor.normal);
  const double drag_1_s = scene.air ? scene.air->drag_kg_m2_s / scene.material.density_kg_m2 : 0.0;
  const double half_m = 0.5 * std::max(model.grid.width_m(), model.grid.height_m());
  const glm::dvec3 reach{half_m, half_m * std::sqrt(1.0 - normal.y * normal.y), half_m};
  constexpr double kStep_s = 1.0 / 240.0;
  glm::dvec3 place = cloth.center_m, velocity{0.0};
  double friction = 0.75 * floor.friction;
  for (double time_s = 0.0; time_s < film_s; time_s += kStep_s) {
    velocity = (velocity + kStep_s * gravity) / (1.0 + kStep_s * drag_1_s);
    place += kStep_s * velocity;
    const double depth_m = -height_above_m(floor, place);
    if (depth_m < 0.0) continue;
    place += depth_m * normal;
    const double into_m_s = std::max(0.0, -glm::dot(velocity, normal));
    velocity += into_m_s * normal;
    const double along_m_s = glm::length(velocity);
    velocity *= along_m_s > 0.0 ? std::max(0.0, 1.0 - friction * into_m_s / along_m_s) : 0.0;
    friction = floor.friction;
    include(bounds, place - reach, place + reach);
  }
}

}  // namespace

double Bounds::radius_m() const { return 0.5 * glm::distance(low, high); }

glm::dvec3 Camera::forward() const {
  return -glm::dvec3(std::sin(yaw_rad) * std::cos(pitch_rad), std::sin(pitch_rad),
                     std::cos(yaw_rad) * std::cos(pitch_rad));
}

glm::dvec3 Camera::right() const { return {std::cos(yaw_rad), 0.0, -std::sin(yaw_rad)}; }

glm::dvec3 Camera::up() const { return glm::cross(right(), forward()); }

glm::dvec3 Camera::eye_m() const { return target_m - distance_m * forward(); }

double Camera::near_m() const { return 0.02 * distance_m; }

glm::mat4 Camera::clip(double aspect) const {
  const double focal = 1.0 / std::tan(0.5 * fov_y_rad);
  const glm::dvec3 eye = eye_m();
  // Row by row: x to the right, y down the picture, the constant near plane, and the view depth as w.
  const glm::dvec3 rows[4] = {right() * (focal / aspect), -up() * focal, glm::dvec3(0.0), forward()};
  const double constants[4] = {0.0, 0.0, near_m(), 0.0};
  glm::mat4 matrix;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) matrix[c][r] = static_cast<float>(rows[r][c]);
    matrix[3][r] = static_cast<float>(constants[r] - glm::dot(rows[r], eye));
  }
  return matrix;
}

Bounds scene_bounds(const Model& model, double film_s) {
  const Scene& scene = model.scene;
  Bounds bounds = start_bounds(start_state(model));
  const double size = std::max(model.grid.width_m(), model.grid.height_m());
  const bool leans = scene.floor && scene.gravity && !scene.floor->is_level();
  if (!scene.pins.empty())
    bounds.low.y = low_with_pins_m(model, bounds.low.y);
  else if (leans)
    for (std::size_t k = 0; k < cloth_count(scene); ++k)
      include_slide(bounds, model, cloth_of(scene, k), film_s);
  else if (scene.floor && scene.gravity) {
    bounds.low.y = std::min(bounds.low.y, scene.floor->height_m);
    for (std::size_t k = 0; k < cloth_count(scene); ++k)
      if (const ClothSection cloth = cloth_of(scene, k); cloth.orientation == Orientation::vertical)
        include_landing(bounds, model, cloth);
  } else if (scene.gravity)
    bounds.low.y -= 0.5 * size;
  for (const SphereSection& sphere : scene.spheres)
    for (const double time_s : {0.0, 1.0}) {
      const glm::dvec3 center = sphere_center_at(sphere, time_s);
      include(bounds, center - sphere.radius_m, center + sphere.radius_m);
    }
  for (std::size_t body = 0; body < body_count(model); ++body)
    for (const double time_s : {0.0, 1.0}) {
      const glm::dvec3 center(body_frame(model, body, time_s)[3]);
      const double reach_m = body_extent_m(model, body);
      include(bounds, center - reach_m, center + reach_m);
    }
  if (scene.floor && scene.floor->is_level()) bounds.low.y = std::max(bounds.low.y, scene.floor->height_m);
  bounds.high = glm::max(bounds.high, bounds.low + 0.05 * size);
  return bounds;
}

Camera default_camera(const Model& model, double aspect, double film_s) {
  const Bounds bounds = scene_bounds(model, film_s);
  const bool lies = model.scene.cloth.orientation == Orientation::horizontal;
  Camera camera;
  camera.target_m = bounds.middle();
  camera.yaw_rad = 30.0 * kDegree;
  camera.pitch_rad = (lies ? 16.5 : 9.0) * kDegree;
  const double tan_y = std::tan(0.5 * camera.fov_y_rad), tan_x = tan_y * aspect;
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p{(corner & 1) != 0 ? bounds.high.x : bounds.low.x,
                       (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
                       (corner & 4) != 0 ? bounds.high.z : bounds.low.z};
    const glm::dvec3 d = p - camera.target_m;
    const double across =
        std::max(std::abs(glm::dot(d, camera.right())) / tan_x, std::abs(glm::dot(d, camera.up())) / tan_y);
    distance = std::max(distance, across - glm::dot(d, camera.forward()));
  }
  camera.distance_m = kMargin * distance;
  return camera;
}

}  // namespace weft
