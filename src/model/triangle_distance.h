// The point of a triangle that is nearest to another point, and the outward direction of what it lies on.
#pragma once
#include <vector>

#include "model/distance_grid.h"

namespace weft {

/// What of a triangle is nearest: its face, the edge from a corner to the next, or a corner.
struct NearestPoint {
  glm::dvec3 point{0.0};
  int edge = -1, corner = -1;  ///< 0 to 2; −1: not
};

NearestPoint nearest_on_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                 const glm::dvec3& c);

/// Angle-weighted pseudonormals: the sign of a point's distance is that of its direction from the nearest
/// point against the pseudonormal there.
/// Source: Baerentzen and Aanaes 2005, Signed distance computation using the angle weighted pseudonormal.
class Pseudonormals {
 public:
  explicit Pseudonormals(const TriangleMesh& mesh);
  glm::dvec3 at(std::uint32_t triangle, const NearestPoint& nearest) const;

 private:
  const TriangleMesh& mesh_;
  std::vector<glm::dvec3> faces_, corners_;
  std::vector<glm::dvec3> edges_;  ///< three a triangle
};

}  // namespace weft
