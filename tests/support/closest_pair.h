// The pair of particles that is nearest, as a share of its limit, by looking at all pairs.
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "model/model.h"

namespace weft::testing_support {

struct ClosestPair {
  double ratio = 1e300;  ///< distance over min(thickness, distance on the flat cloth)
  std::uint32_t a = 0, b = 0;
};

/// O(n²), and independent of everything that src/passes knows of limits and grids.
inline ClosestPair closest_pair(const Model& model, const State& state) {
  const Grid& grid = model.grid;
  const double thickness_m = model.scene.self_collision->thickness_m;
  ClosestPair closest;
  for (std::uint32_t a = 0; a < grid.count(); ++a)
    for (std::uint32_t b = a + 1; b < grid.count(); ++b) {
      const glm::dvec3 d = state.position[b] - state.position[a];
      const double q = glm::dot(d, d);
      if (!(q < closest.ratio * closest.ratio * thickness_m * thickness_m)) continue;
      const double di = double(a % grid.nx) - double(b % grid.nx),
                   dj = double(a / grid.nx) - double(b / grid.nx);
      const bool one_cloth = a / (grid.nx * grid.ny) == b / (grid.nx * grid.ny);
      const double flat_m = one_cloth ? grid.spacing_m * std::hypot(di, dj) : thickness_m;
      const double limit_m = std::min(thickness_m, flat_m);
      if (std::sqrt(q) < closest.ratio * limit_m) closest = {std::sqrt(q) / limit_m, a, b};
    }
  return closest;
}

}  // namespace weft::testing_support
