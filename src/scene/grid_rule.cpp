// Where the particles of a scene's cloth start.
#include "scene/grid_rule.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace weft {
namespace {

constexpr double kPi = std::numbers::pi;

/// The imperfection's wave along one side: sin(waves·pi·k/(count − 1) + phase).
std::vector<double> wave(std::size_t count, double waves, double phase) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k)
    values[k] = std::sin(waves * kPi * static_cast<double>(k) / static_cast<double>(count - 1) + phase);
  return values;
}

/// Distance from `target` to the nearest of 0, a, 2a, … (count − 1)·a.
double nearest_on_line(double target, double a, double count) {
  return std::abs(std::clamp(std::round(target / a), 0.0, count - 1.0) * a - target);
}

}  // namespace

double cell_m(const ClothSection& cloth) { return cloth.width_m / (cloth.resolution - 1); }

double rows_along_height(const ClothSection& cloth) {
  return std::round(cloth.height_m / cell_m(cloth)) + 1.0;
}

double nearest_particle_m(const ClothSection& cloth, glm::dvec2 at) {
  const double a = cell_m(cloth), rows = rows_along_height(cloth);
  return std::hypot(nearest_on_line(at.x * cloth.width_m, a, cloth.resolution),
                    nearest_on_line(at.y * a * (rows - 1.0), a, rows));
}

namespace {

void deepen(const Scene& scene, const ClothSection& cloth, double half_thickness_m, StartDepths& depths) {
  const double a = cell_m(cloth);
  const auto nx = static_cast<std::size_t>(cloth.resolution);
  const auto ny = static_cast<std::size_t>(rows_along_height(cloth));
  const double half_height_m = 0.5 * a * static_cast<double>(ny - 1);
  const std::vector<double> along_i = wave(nx, 3.0, 0.4), along_j = wave(ny, 2.0, 0.9);
  const bool is_vertical = cloth.orientation == Orientation::vertical;
  for (std::size_t j = 0; j < ny; ++j) {
    for (std::size_t i = 0; i < nx; ++i) {
      const double u = static_cast<double>(i) * a - 0.5 * cloth.width_m, s = static_cast<double>(j) * a;
      const double off = cloth.imperfection_m * along_i[i] * along_j[j];
      const glm::dvec3 local =
          is_vertical ? glm::dvec3(u, half_height_m - s, off) : glm::dvec3(u, off, s - half_height_m);
      const glm::dvec3 place = cloth.center_m + local;
      if (scene.floor) {
        const glm::dvec3 above = place - glm::dvec3(0.0, scene.floor->height_m, 0.0);
        const double height_m = glm::dot(above, glm::normalize(scene.floor->normal));
        depths.floor_m = std::max(depths.floor_m, half_thickness_m - height_m);
      }
      for (std::size_t k = 0; k < scene.spheres.size(); ++k) {
        const SphereSection& sphere = scene.spheres[k];
        const double inside_m = sphere.radius_m + half_thickness_m - glm::distance(place, sphere.center_m);
        depths.sphere_m[k] = std::max(depths.sphere_m[k], inside_m);
      }
    }
  }
}

}  // namespace

StartDepths start_depths(const Scene& scene, double half_thickness_m) {
  StartDepths depths{-std::numeric_limits<double>::infinity(),
                     std::vector<double>(scene.spheres.size(), -std::numeric_limits<double>::infinity())};
  for (std::size_t cloth = 0; cloth < cloth_count(scene); ++cloth)
    deepen(scene, cloth_of(scene, cloth), half_thickness_m, depths);
  return depths;
}

}  // namespace weft
