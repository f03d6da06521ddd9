// Ray and triangle after Möller and Trumbore 1997, both sides.
#include "viewer/pick.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace weft {
namespace {

struct Hit {
  double distance, u, v;
};

std::optional<Hit> meet_triangle(const Ray& ray, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a;
  const glm::dvec3 p = glm::cross(ray.direction, ac);
  const double determinant = glm::dot(ab, p);
  if (std::abs(determinant) < 1e-300) return std::nullopt;
  const glm::dvec3 from = ray.origin - a;
  const double u = glm::dot(from, p) / determinant;
  if (!(u >= 0.0 && u <= 1.0)) return std::nullopt;
  const glm::dvec3 q = glm::cross(from, ab);
  const double v = glm::dot(ray.direction, q) / determinant;
  if (!(v >= 0.0 && u + v <= 1.0)) return std::nullopt;
  const double distance = glm::dot(ac, q) / determinant;
  if (!(distance > 0.0)) return std::nullopt;
  return Hit{distance, u, v};
}

}  // namespace

Ray camera_ray(const Camera& camera, double aspect, glm::dvec2 point) {
  const double half = std::tan(0.5 * camera.fov_y_rad);
  const glm::dvec3 direction = camera.forward() + (2.0 * point.x - 1.0) * half * aspect * camera.right() +
                               (1.0 - 2.0 * point.y) * half * camera.up();
  return {camera.eye_m(), glm::normalize(direction)};
}

std::optional<Pick> pick_cloth(const Grid& grid, const State& state, const Ray& ray) {
  std::optional<Pick> best;
  const auto test = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto hit = meet_triangle(ray, state.position[a], state.position[b], state.position[c]);
    if (!hit || (best && hit->distance >= best->distance_m)) return;
    const double first = 1.0 - hit->u - hit->v;
    const std::uint32_t corner = first >= hit->u && first >= hit->v ? a : (hit->u >= hit->v ? b : c);
    best = Pick{corner, ray.origin + hit->distance * ray.direction, hit->distance};
  };
  for (std::uint32_t j = 0; j + 1 < grid.rows(); ++j) {
    if (grid.own_row(j) + 1 == grid.ny) continue;  // below it is another cloth
    for (std::uint32_t i = 0; i + 1 < grid.nx; ++i) {
      const std::uint32_t corner = grid.index(i, j), below = grid.index(i, j + 1);
      test(corner, below, corner + 1);
      test(corner + 1, below, below + 1);
    }
  }
  return best;
}

std::optional<glm::dvec3> meet_plane(const Ray& ray, const glm::dvec3& point, const glm::dvec3& normal) {
  const double slope = glm::dot(ray.direction, normal);
  if (std::abs(slope) < 1e-9) return std::nullopt;
  const double distance = glm::dot(point - ray.origin, normal) / slope;
  if (!(distance > 0.0)) return std::nullopt;
  return ray.origin + distance * ray.direction;
}

}  // namespace weft
