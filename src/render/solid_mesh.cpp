// Triangles of capsules, boxes and meshes, generated.
#include "render/solid_mesh.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "model/distance_grid.h"
#include "model/solids.h"

namespace weft {
namespace {

constexpr double kMeshInset = 0.2;  // of a cell of the cloth
constexpr double kSharpest = 0.8;   // cosine; where faces meet at more, an edge is drawn sharp
constexpr std::uint32_t kRoundSegments = 48, kRoundRings = 12;  // of a capsule: around, and each end

/// A flat triangle between particles that rest on both sides of an edge cuts it by up to half a cell, and
/// over a curve by less: so much thinner is drawn what is bent by `radius_m`, and sharp edges are at 0.
double inset_m(double radius_m, double spacing_m) {
  const double chord_m = 0.78 * spacing_m;
  if (radius_m <= chord_m) return 0.4 * spacing_m;
  return radius_m - std::sqrt(radius_m * radius_m - chord_m * chord_m);
}

/// But a fifth of a body's size at most.
double drawn_m(double size_m, double inset_m) { return std::max(0.8 * size_m, size_m - inset_m); }

class Builder {
 public:
  explicit Builder(SolidTriangles& out) : out_(out) {}
  void begin() { out_.bodies.push_back({std::uint32_t(out_.indices.size()), 0}); }
  std::uint32_t vertex(const glm::dvec3& x, const glm::dvec3& n) {
    out_.position.emplace_back(glm::vec3(x), 1.0f);
    out_.normal.emplace_back(glm::vec3(n), 0.0f);
    return std::uint32_t(out_.position.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t index : {a, b, c}) out_.indices.push_back(index);
    out_.bodies.back().index_count += 3;
  }

 private:
  SolidTriangles& out_;
};

/// Six faces of four vertices each.
void add_box(const glm::dvec3& half, Builder& out) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 n(0.0), u(0.0), v(0.0);
      n[axis] = side;
      u[(axis + 1) % 3] = half[(axis + 1) % 3];
      v[(axis + 2) % 3] = side * half[(axis + 2) % 3];
      const glm::dvec3 middle = n * half;
      const std::uint32_t a = out.vertex(middle - u - v, n), b = out.vertex(middle + u - v, n);
      const std::uint32_t c = out.vertex(middle + u + v, n), d = out.vertex(middle - u + v, n);
      out.triangle(a, b, c);
      out.triangle(a, c, d);
    }
}

/// Rings from one end to the other along y; the two at the equators are the tube's.
void add_capsule(double half_m, double radius_m, Builder& out) {
  std::vector<std::vector<std::uint32_t>> rings;
  for (std::uint32_t ring = 0; ring <= 2 * kRoundRings + 1; ++ring) {
    const bool upper = ring <= kRoundRings;
    const std::uint32_t step = upper ? ring : ring - 1;
    const double polar = std::numbers::pi * step / (2.0 * kRoundRings);
    rings.emplace_back();
    for (std::uint32_t segment = 0; segment <= kRoundSegments; ++segment) {
      const double around = 2.0 * std::numbers::pi * segment / kRoundSegments;
      const glm::dvec3 n(std::sin(polar) * std::sin(around), std::cos(polar),
                         std::sin(polar) * std::cos(around));
      const glm::dvec3 end(0.0, upper ? half_m : -half_m, 0.0);
      rings.back().push_back(out.vertex(end + radius_m * n, n));
    }
  }
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring)
    for (std::size_t s = 0; s < kRoundSegments; ++s) {
      out.triangle(rings[ring][s], rings[ring + 1][s], rings[ring][s + 1]);
      out.triangle(rings[ring][s + 1], rings[ring + 1][s], rings[ring + 1][s + 1]);
    }
}

/// Each corner's normal is the sum over the faces at its vertex that lean little against its own.
void add_mesh(const TriangleMesh& mesh, double inset_m, Builder& out) {
  std::vector<glm::dvec3> faces;
  std::vector<std::vector<std::size_t>> around(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const glm::uvec3& k = mesh.triangles[t];
    const glm::dvec3& a = mesh.vertices[k.x];
    faces.push_back(glm::cross(mesh.vertices[k.y] - a, mesh.vertices[k.z] - a));
    for (int corner = 0; corner < 3; ++corner) around[k[corner]].push_back(t);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::uint32_t made[3];
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t at = mesh.triangles[t][corner];
      glm::dvec3 n(0.0);
      for (const std::size_t other : around[at])
        if (glm::dot(faces[t], faces[other]) >= kSharpest * glm::length(faces[t]) * glm::length(faces[other]))
          n += faces[other];
      const double l = glm::length(n);
      n = l > 0.0 ? n / l : glm::dvec3(0.0, 1.0, 0.0);
      made[corner] = out.vertex(mesh.vertices[at] - inset_m * n, n);
    }
    out.triangle(made[0], made[1], made[2]);
  }
}

}  // namespace

SolidTriangles solid_triangles(const Model& model) {
  SolidTriangles made;
  Builder out(made);
  const double a = model.grid.spacing_m;
  for (const Solid& solid : solids_of(model.scene)) {
    out.begin();
    if (solid.radius_m > 0.0)
      add_capsule(solid.half_m.y, drawn_m(solid.radius_m, inset_m(solid.radius_m, a)), out);
    else
      add_box({drawn_m(solid.half_m.x, inset_m(0.0, a)), drawn_m(solid.half_m.y, inset_m(0.0, a)),
               drawn_m(solid.half_m.z, inset_m(0.0, a))},
              out);
  }
  for (const auto& mesh : model.meshes) {
    out.begin();
    add_mesh(mesh->mesh, std::min(kMeshInset * a, 0.02 * longest_side_m(mesh->mesh)), out);
  }
  return made;
}

std::size_t body_count(const Model& model) {
  return model.scene.capsules.size() + model.scene.boxes.size() + model.meshes.size();
}

glm::mat4 body_frame(const Model& model, std::size_t body, double time_s) {
  const std::vector<Solid> solids = solids_of(model.scene);
  const SolidFrame frame = body < solids.size() ? frame_at(solids[body], time_s)
                                                : frame_at(model.scene.meshes[body - solids.size()], time_s);
  glm::mat4 matrix(glm::mat3(frame.axes));
  matrix[3] = glm::vec4(glm::vec3(frame.center_m), 1.0f);
  return matrix;
}

double body_extent_m(const Model& model, std::size_t body) {
  const std::vector<Solid> solids = solids_of(model.scene);
  if (body < solids.size()) return extent_m(solids[body]);
  double farthest_m = 0.0;
  for (const glm::dvec3& x : model.meshes[body - solids.size()]->mesh.vertices)
    farthest_m = std::max(farthest_m, glm::length(x));
  return farthest_m;
}

}  // namespace weft
