// How many edges of the cloth pass through its triangles, counted exactly, and independent of everything that
// src/passes knows of grids and distances.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <vector>

#include "model/model.h"
#include "support/exact_sign.h"

namespace weft::testing_support {

using Corners = std::array<std::uint32_t, 3>;

inline std::vector<Corners> triangles_of(const Grid& g) {
  std::vector<Corners> triangles;
  for (std::uint32_t j = 0; j + 1 < g.rows(); ++j)
    for (std::uint32_t i = 0; i + 1 < g.nx && (j + 1) % g.ny != 0; ++i) {  // nothing joins two cloths
      triangles.push_back({g.index(i, j), g.index(i, j + 1), g.index(i + 1, j)});
      triangles.push_back({g.index(i + 1, j), g.index(i, j + 1), g.index(i + 1, j + 1)});
    }
  return triangles;
}

inline std::vector<std::array<std::uint32_t, 2>> edges_of(const Grid& g) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t j = 0; j < g.rows(); ++j)
    for (std::uint32_t i = 0; i < g.nx; ++i) {
      const bool below = (j + 1) % g.ny != 0;
      if (i + 1 < g.nx) edges.push_back({g.index(i, j), g.index(i + 1, j)});
      if (below) edges.push_back({g.index(i, j), g.index(i, j + 1)});
      if (i + 1 < g.nx && below) edges.push_back({g.index(i + 1, j), g.index(i, j + 1)});
    }
  return edges;
}

/// Whether the edge passes through the triangle or touches it; not when it lies in its plane.
inline bool crosses(const std::vector<glm::dvec3>& x, const std::array<std::uint32_t, 2>& edge,
                    const Corners& t) {
  for (const std::uint32_t end : edge)
    if (std::ranges::count(t, end) > 0) return false;  // joined there
  const glm::dvec3 &p = x[edge[0]], &q = x[edge[1]], &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
  const int from = side_of_plane(a, b, c, p), to = side_of_plane(a, b, c, q);
  if (from * to > 0 || (from == 0 && to == 0)) return false;
  const int s0 = side_of_plane(p, q, a, b), s1 = side_of_plane(p, q, b, c), s2 = side_of_plane(p, q, c, a);
  return std::min({s0, s1, s2}) >= 0 || std::max({s0, s1, s2}) <= 0;
}

struct Box {
  glm::dvec3 low{1e300}, high{-1e300};
  void cover(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  bool meets(const Box& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y &&
           low.z <= o.high.z && o.low.z <= high.z;
  }
};

/// A tree of boxes round the triangles, each half of the ones above by place.
class TriangleTree {
 public:
  TriangleTree(const std::vector<glm::dvec3>& x, std::vector<Corners> triangles)
      : x_(x), triangles_(std::move(triangles)) {
    if (!triangles_.empty()) build(0, triangles_.size());
  }
  /// Calls visit(triangle) for each whose box meets the other.
  template <class Visit>
  void visit(const Box& box, Visit&& visit_triangle, std::size_t node = 0) const {
    if (nodes_.empty() || !nodes_[node].box.meets(box)) return;
    const Node& n = nodes_[node];
    if (n.left != 0) {
      visit(box, visit_triangle, n.left);
      visit(box, visit_triangle, n.right);
      return;
    }
    for (std::size_t k = n.begin; k < n.end; ++k) visit_triangle(triangles_[k]);
  }

 private:
  struct Node {
    Box box;
    std::size_t begin = 0, end = 0, left = 0, right = 0;
  };
  std::size_t build(std::size_t begin, std::size_t end) {
    const std::size_t node = nodes_.size();
    nodes_.push_back({{}, begin, end, 0, 0});
    Box box;
    for (std::size_t k = begin; k < end; ++k)
      for (const std::uint32_t corner : triangles_[k]) box.cover(x_[corner]);
    nodes_[node].box = box;
    if (end - begin <= 8) return node;
    const glm::dvec3 size = box.high - box.low;
    const int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t k) { return triangles_.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end),
                     [&](const Corners& l, const Corners& r) { return x_[l[0]][axis] < x_[r[0]][axis]; });
    const std::size_t left = build(begin, middle), right = build(middle, end);
    nodes_[node].left = left, nodes_[node].right = right;
    return node;
  }
  const std::vector<glm::dvec3>& x_;
  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

/// Pairs of an edge and a triangle without a common particle that cross.
inline std::size_t crossing_count(const Grid& grid, const std::vector<glm::dvec3>& x) {
  const TriangleTree tree(x, triangles_of(grid));
  std::size_t count = 0;
  for (const auto& edge : edges_of(grid)) {
    Box box;
    for (const std::uint32_t end : edge) box.cover(x[end]);
    tree.visit(box, [&](const Corners& t) { count += crosses(x, edge, t) ? 1u : 0u; });
  }
  return count;
}

/// The same by looking at all pairs.
inline std::size_t crossing_count_of_all(const Grid& grid, const std::vector<glm::dvec3>& x) {
  const std::vector<Corners> triangles = triangles_of(grid);
  std::size_t count = 0;
  for (const auto& edge : edges_of(grid))
    for (const Corners& t : triangles) count += crosses(x, edge, t) ? 1u : 0u;
  return count;
}

}  // namespace weft::testing_support
