// The wind's noise: bounded, without a mean, and smooth over its scale.
#include "passes/wind_noise.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace weft {
namespace {

AirRow<double> eddies(double slice = 0.0, double share = 0.0) {
  AirRow<double> air{};
  air.cells_1_m = 2.0;
  air.slice = slice;
  air.slice_share = share;
  return air;
}

// Over many lattice points each component has the mean 0 and the variance 1/3 of an even spread in (−1, 1),
// within four standard errors: 4/√(3·n) and 4·√(4/45)/√n.
TEST(WindNoise, IsEvenlySpread) {
  glm::dvec3 sum(0.0), squares(0.0);
  constexpr int kSide = 30, kCount = kSide * kSide * kSide;
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z) {
        const glm::dvec3 n = lattice_vector<double>({x, y, z}, 5, 9);
        EXPECT_LT(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1.0);
        sum += n;
        squares += n * n;
      }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / kCount, 0.0, 4.0 / std::sqrt(3.0 * kCount));
    EXPECT_NEAR(squares[axis] / kCount, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / kCount));
  }
}

// Across cells, slices of time and the lattice's end it has no jumps: a thousandth of a cell changes it by at
// most 1.5 (the steepest slope of the blend) times 2 (the largest difference), in each axis.
TEST(WindNoise, IsSmooth) {
  for (double x = -1.05; x < 1.05; x += 0.0005) {
    const glm::dvec3 a = wind_noise(eddies(), glm::dvec3(x, 0.3, -0.2), 4);
    const glm::dvec3 b = wind_noise(eddies(), glm::dvec3(x + 0.0005, 0.3, -0.2), 4);
    EXPECT_LE(glm::length(b - a), 0.001 * 3.0 * std::sqrt(3.0));
  }
  const glm::dvec3 at(0.1, 0.2, 0.3), end = wind_noise(eddies(7.0, 1.0), at, 4);
  EXPECT_LE(glm::distance(end, wind_noise(eddies(8.0, 0.0), at, 4)), 1e-12);
  AirRow<double> wrapped = eddies();
  wrapped.origin = glm::dvec3(1024.0);
  EXPECT_LE(glm::distance(wind_noise(wrapped, at, 4), wind_noise(eddies(), at, 4)), 1e-10);
}

}  // namespace
}  // namespace weft
