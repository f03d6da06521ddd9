// Fills the view block: camera rays, the light's matrix, the floor's squares, spheres and pin heads.
#include "render/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/motion.h"
#include "model/solids.h"

namespace weft {
namespace {

const glm::dvec3 kToLight = glm::normalize(glm::dvec3(-0.52, 1.0, 0.62));
constexpr double kPinHead = 0.011;      // radius, as a share of the cloth's size
constexpr double kFloorGap = 0.0012;    // the drawn floor lies lower than the real one by this share
constexpr double kShadowMargin = 1.25;  // the shadow map covers this many radii of the scene

double cloth_size_m(const Model& model) { return std::max(model.grid.width_m(), model.grid.height_m()); }

/// A sphere small enough that the flat triangles between particles resting on it stay outside.
/// A cell's circumradius is a/√2; a tenth of it is left for stretch.
double drawn_radius_m(double radius_m, double spacing_m) {
  const double chord = 0.78 * spacing_m;
  return std::max(0.8 * radius_m, std::sqrt(std::max(radius_m * radius_m - chord * chord, 0.0))) * 0.998;
}

glm::dvec3 pin_place_m(const Model& model, const PinSection& pin, double time_s) {
  const ClothSection cloth = cloth_of(model.scene, pin.cloth);
  const double u = (pin.at.x - 0.5) * model.grid.width_m(), s = (0.5 - pin.at.y) * model.grid.height_m();
  const bool lies = cloth.orientation == Orientation::horizontal;
  return cloth.center_m + pin_offset_at(model.scene, pin, time_s) +
         (lies ? glm::dvec3(u, 0.0, -s) : glm::dvec3(u, s, 0.0));
}

std::uint32_t sphere_count(const Model& model) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(model.scene.spheres.size(), shared::kMaxBalls));
}

void place_balls(const Model& model, double time_s, shared::View& view) {
  view.sphere_count = sphere_count(model);
  view.ball_count = ball_count(model);
  for (std::uint32_t k = 0; k < view.sphere_count; ++k) {
    const SphereSection& sphere = model.scene.spheres[k];
    view.balls[k] =
        glm::vec4(sphere_center_at(sphere, time_s), drawn_radius_m(sphere.radius_m, model.grid.spacing_m));
  }
  for (std::uint32_t k = view.sphere_count; k < view.ball_count; ++k) {
    const PinSection& pin = model.scene.pins[k - view.sphere_count];
    const double radius_m = has_released(pin, time_s) ? 0.0 : kPinHead * cloth_size_m(model);
    view.balls[k] = glm::vec4(pin_place_m(model, pin, time_s), radius_m);
  }
}

/// Orthographic along the light. Its depth reaches from two radii above the scene down through the floor.
void place_light(const Model& model, const Stage& stage, shared::View& view) {
  const glm::dvec3 middle = stage.bounds.middle();
  const double radius = kShadowMargin * stage.bounds.radius_m();
  const glm::dvec3 side = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), kToLight));
  const glm::dvec3 up = glm::cross(kToLight, side);
  double below = 2.0 * radius;
  if (model.scene.floor)
    below = std::max(below, (middle.y - model.scene.floor->height_m + radius) / kToLight.y + radius);
  const double above = 2.0 * radius, depth = above + below;
  const glm::dvec3 rows[4] = {side / radius, up / radius, -kToLight / depth, glm::dvec3(0.0)};
  const double constants[4] = {0.0, 0.0, above / depth, 1.0};
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 3; ++c) view.shadow_clip[c][r] = static_cast<float>(rows[r][c]);
    view.shadow_clip[3][r] = static_cast<float>(constants[r] - glm::dot(rows[r], middle));
  }
  view.to_light = kToLight;
  view.shadow_texel_m = static_cast<float>(2.0 * radius / stage.shadow_size);
  view.shadow_depth_m = static_cast<float>(depth);
}

/// The edge of a floor square: a quarter of the cloth, rounded to 1, 2 or 5 times a power of ten.
double checker_m(double size_m) {
  const double wish = 0.25 * size_m, decade = std::pow(10.0, std::floor(std::log10(wish)));
  for (const double step : {1.0, 2.0, 5.0})
    if (wish < 1.5 * step * decade) return step * decade;
  return 10.0 * decade;
}

}  // namespace

std::uint32_t ball_count(const Model& model) {
  return static_cast<std::uint32_t>(
      std::min<std::size_t>(sphere_count(model) + model.scene.pins.size(), shared::kMaxBalls));
}

shared::View make_view(const Model& model, const Stage& stage, const Camera& camera, double aspect,
                       double time_s, double heat_full) {
  shared::View view{};
  const double size = cloth_size_m(model), tan_y = std::tan(0.5 * camera.fov_y_rad);
  view.clip = camera.clip(aspect);
  view.eye_m = camera.eye_m();
  view.ray_right = camera.right() * (tan_y * aspect);
  view.ray_up = camera.up() * tan_y;
  view.ray_forward = camera.forward();
  view.focus_m = stage.bounds.middle();
  view.floor_m =
      model.scene.floor ? static_cast<float>(model.scene.floor->height_m - kFloorGap * size) : 0.0f;
  view.floor_normal =
      model.scene.floor ? glm::vec3(floor_plane(*model.scene.floor).normal) : glm::vec3(0.0f, 1.0f, 0.0f);
  view.checker_m = static_cast<float>(checker_m(size));
  view.fade_m = static_cast<float>(9.0 * stage.bounds.radius_m());
  view.heat_full = static_cast<float>(heat_full);
  view.cloth_m = glm::vec2(model.grid.width_m(), model.grid.height_m());
  view.spacing_m = static_cast<float>(model.grid.spacing_m);
  view.nx = model.grid.nx;
  view.ny = model.grid.ny;
  view.cloths = model.grid.cloths;
  place_light(model, stage, view);
  place_balls(model, time_s, view);
  return view;
}

}  // namespace weft
