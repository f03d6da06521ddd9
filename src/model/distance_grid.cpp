// From a closed mesh to distances on a grid: exact near the surface, by the nearest triangle of a neighbour
// farther away. Source: Bridson 2015, Fluid simulation for computer graphics, 2nd ed., section 4.6 (closest
// triangles, handed on by sweeps).
#include "model/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"
#include "model/triangle_distance.h"

namespace weft {
namespace {

constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();
constexpr double kBandCells = 2.0;  // up to here each sample is compared with every triangle near it

class GridBuilder {
 public:
  GridBuilder(DistanceGrid& grid)
      : grid_(grid), count_(std::size_t{grid.samples.x} * grid.samples.y * grid.samples.z) {
    least_.assign(count_, std::numeric_limits<double>::infinity());
    nearest_.assign(count_, kNoTriangle);
    sign_.assign(count_, 0);
  }

  void build() {
    for (std::uint32_t t = 0; t < grid_.mesh.triangles.size(); ++t) mark_near(t);
    sign_near();
    for (int direction = 0; direction < 8; ++direction) sweep(direction);
    hand_on_signs();
    grid_.distance.resize(count_);
    for (std::size_t k = 0; k < count_; ++k)
      grid_.distance[k] = static_cast<float>((sign_[k] < 0 ? -1.0 : 1.0) * std::sqrt(least_[k]));
  }

 private:
  std::size_t index(const glm::ivec3& at) const {
    return (std::size_t(at.z) * grid_.samples.y + std::size_t(at.y)) * grid_.samples.x + std::size_t(at.x);
  }
  glm::dvec3 place(const glm::ivec3& at) const { return grid_.low_m + grid_.cell_m * glm::dvec3(at); }
  glm::ivec3 last() const { return glm::ivec3(grid_.samples) - 1; }
  bool has(const glm::ivec3& at) const {
    return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x <= last().x && at.y <= last().y && at.z <= last().z;
  }
  NearestPoint nearest(const glm::ivec3& at, std::uint32_t t) const {
    const glm::uvec3& corner = grid_.mesh.triangles[t];
    const auto& x = grid_.mesh.vertices;
    return nearest_on_triangle(place(at), x[corner.x], x[corner.y], x[corner.z]);
  }

  void offer(const glm::ivec3& at, std::uint32_t t) {
    const glm::dvec3 way = place(at) - nearest(at, t).point;
    const double squared = glm::dot(way, way);
    const std::size_t k = index(at);
    if (!(squared < least_[k])) return;
    least_[k] = squared;
    nearest_[k] = t;
  }

  /// Offers a triangle to every sample within the band of its bounding box.
  void mark_near(std::uint32_t t) {
    glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec3& x = grid_.mesh.vertices[grid_.mesh.triangles[t][corner]];
      low = glm::min(low, x);
      high = glm::max(high, x);
    }
    const glm::dvec3 from = glm::floor((low - grid_.low_m) / grid_.cell_m - kBandCells);
    const glm::dvec3 to = glm::ceil((high - grid_.low_m) / grid_.cell_m + kBandCells);
    const glm::ivec3 first = glm::max(glm::ivec3(from), 0), end = glm::min(glm::ivec3(to), last());
    for (int z = first.z; z <= end.z; ++z)
      for (int y = first.y; y <= end.y; ++y)
        for (int x = first.x; x <= end.x; ++x) offer({x, y, z}, t);
  }

  /// The sign where the nearest triangle is known for certain.
  void sign_near() {
    const Pseudonormals normals(grid_.mesh);
    const double band_m = kBandCells * grid_.cell_m;
    for_each([&](const glm::ivec3& at) {
      const std::size_t k = index(at);
      if (!(least_[k] <= band_m * band_m)) return;
      const NearestPoint on = nearest(at, nearest_[k]);
      sign_[k] = glm::dot(place(at) - on.point, normals.at(nearest_[k], on)) < 0.0 ? -1 : 1;
    });
  }

  /// Goes through the grid in one of its eight directions and offers each sample its predecessors' triangles.
  void sweep(int direction) {
    const glm::ivec3 step((direction & 1) != 0 ? -1 : 1, (direction & 2) != 0 ? -1 : 1,
                          (direction & 4) != 0 ? -1 : 1);
    for_each([&](glm::ivec3 at) {
      for (int axis = 0; axis < 3; ++axis)
        if (step[axis] < 0) at[axis] = last()[axis] - at[axis];
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 before = at;
        before[axis] -= step[axis];
        if (!has(before)) continue;
        const std::uint32_t t = nearest_[index(before)];
        if (t != kNoTriangle && t != nearest_[index(at)]) offer(at, t);
      }
    });
  }

  /// Beyond the band no neighbours lie on different sides of the surface.
  void hand_on_signs() {
    std::vector<glm::ivec3> front;
    for_each([&](const glm::ivec3& at) {
      if (sign_[index(at)] != 0) front.push_back(at);
    });
    while (!front.empty()) {
      std::vector<glm::ivec3> next;
      for (const glm::ivec3& at : front)
        for (int side = 0; side < 6; ++side) {
          glm::ivec3 beside = at;
          beside[side / 2] += side % 2 == 0 ? 1 : -1;
          if (!has(beside) || sign_[index(beside)] != 0) continue;
          sign_[index(beside)] = sign_[index(at)];
          next.push_back(beside);
        }
      front = std::move(next);
    }
  }

  template <class Visit>
  void for_each(Visit&& visit) const {
    for (int z = 0; z <= last().z; ++z)
      for (int y = 0; y <= last().y; ++y)
        for (int x = 0; x <= last().x; ++x) visit(glm::ivec3(x, y, z));
  }

  DistanceGrid& grid_;
  std::size_t count_;
  std::vector<double> least_;  // squared
  std::vector<std::uint32_t> nearest_;
  std::vector<signed char> sign_;
};

struct Box {
  glm::dvec3 low, size;
};

Box box_of(const TriangleMesh& mesh) {
  glm::dvec3 low(std::numeric_limits<double>::max()), high(-low);
  for (const glm::dvec3& v : mesh.vertices) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  return {low, high - low};
}

}  // namespace

double longest_side_m(const TriangleMesh& mesh) {
  const auto [low, size] = box_of(mesh);
  return std::max({size.x, size.y, size.z});
}

DistanceGrid make_distance_grid(TriangleMesh mesh, std::uint32_t cells, double margin_m) {
  DistanceGrid grid;
  const auto [low, size] = box_of(mesh);
  grid.cell_m = longest_side_m(mesh) / cells;
  const double around_m = margin_m + 2.0 * grid.cell_m;
  grid.low_m = low - around_m;
  grid.samples = glm::uvec3(glm::ceil((size + 2.0 * around_m) / grid.cell_m)) + 1u;
  grid.mesh = std::move(mesh);
  GridBuilder(grid).build();
  return grid;
}

double distance_at(const DistanceGrid& grid, const glm::dvec3& own_m) {
  const glm::dvec3 last = glm::dvec3(grid.samples - 1u);
  const glm::dvec3 wanted = (own_m - grid.low_m) / grid.cell_m, q = glm::clamp(wanted, glm::dvec3(0.0), last);
  const glm::uvec3 cell = glm::uvec3(glm::min(glm::floor(q), last - 1.0));
  const glm::dvec3 t = q - glm::dvec3(cell);
  double sum = 0.0;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    const glm::uvec3 at = cell + glm::uvec3(corner & 1u, (corner >> 1) & 1u, corner >> 2);
    const double weight = ((corner & 1u) != 0 ? t.x : 1.0 - t.x) * ((corner & 2u) != 0 ? t.y : 1.0 - t.y) *
                          ((corner & 4u) != 0 ? t.z : 1.0 - t.z);
    sum +=
        weight * double(grid.distance[(std::size_t{at.z} * grid.samples.y + at.y) * grid.samples.x + at.x]);
  }
  return sum + grid.cell_m * glm::length(wanted - q);
}

SolidFrame frame_at(const MeshSection& mesh, double time_s) {
  return frame_at(mesh, {mesh.center_m, rotation_matrix(mesh.rotation_deg)}, time_s);
}

}  // namespace weft
