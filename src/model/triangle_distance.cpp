// Nearest points of triangles and pseudonormals.
#include "model/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace weft {
namespace {

/// The nearest point of the segment a–b; its end when that is nearest.
NearestPoint nearest_on_edge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, int edge) {
  const glm::dvec3 along = b - a;
  const double t = glm::dot(p - a, along) / glm::dot(along, along);
  if (!(t > 0.0)) return {.point = a, .corner = edge};
  if (t >= 1.0) return {.point = b, .corner = (edge + 1) % 3};
  return {.point = a + t * along, .edge = edge};
}

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

NearestPoint nearest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double nn = glm::dot(n, n);
  const glm::dvec3 corners[3] = {a, b, c};
  bool over = nn > 0.0;  // whether p lies over the face: on the inner side of all three edges
  for (int k = 0; k < 3 && over; ++k) {
    const glm::dvec3 edge = corners[(k + 1) % 3] - corners[k];
    over = glm::dot(glm::cross(edge, p - corners[k]), n) > 0.0;
  }
  if (over) return {.point = p - n * (glm::dot(p - a, n) / nn)};
  NearestPoint best;
  double least = -1.0;
  for (int k = 0; k < 3; ++k) {
    const NearestPoint on_edge = nearest_on_edge(p, corners[k], corners[(k + 1) % 3], k);
    const glm::dvec3 way = p - on_edge.point;
    const double squared = glm::dot(way, way);
    if (least >= 0.0 && squared >= least) continue;
    least = squared;
    best = on_edge;
  }
  return best;
}

Pseudonormals::Pseudonormals(const TriangleMesh& mesh)
    : mesh_(mesh), corners_(mesh.vertices.size(), glm::dvec3(0.0)), edges_(3 * mesh.triangles.size()) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, glm::dvec3> sums;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 x[3] = {mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]};
    const glm::dvec3 n = glm::cross(x[1] - x[0], x[2] - x[0]);
    const double l = glm::length(n);
    faces_.push_back(l > 0.0 ? n / l : glm::dvec3(0.0));
    for (int k = 0; k < 3; ++k) {
      sums.try_emplace(std::minmax(t[k], t[(k + 1) % 3]), 0.0).first->second += faces_.back();
      const double angle = angle_between(x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k]);
      corners_[t[k]] += angle * faces_.back();
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      edges_[3 * t + std::size_t(k)] =
          sums.at(std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]));
}

glm::dvec3 Pseudonormals::at(std::uint32_t triangle, const NearestPoint& nearest) const {
  if (nearest.corner >= 0) return corners_[mesh_.triangles[triangle][nearest.corner]];
  if (nearest.edge >= 0) return edges_[3 * std::size_t(triangle) + std::size_t(nearest.edge)];
  return faces_[triangle];
}

}  // namespace weft
