// The definition of the error, on trajectories whose distance is known, and the comparison of resolutions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "study/trajectory.h"

namespace weft::study {
namespace {

State state_of(const std::vector<glm::dvec3>& position, double time_s) {
  State state;
  state.position = position;
  state.velocity.assign(position.size(), glm::dvec3(0.0));
  state.time_s = time_s;
  return state;
}

TEST(Error, IsTheLargestOverFramesOfTheRmsOverParticles) {
  const std::vector<glm::dvec3> still(4, glm::dvec3(1.0, 2.0, 3.0));
  std::vector<glm::dvec3> one_off = still, all_off = still;
  one_off[2] += glm::dvec3(0.0, 0.06, 0.08);                      // 0.1 m: the RMS over four is 0.05 m
  for (glm::dvec3& x : all_off) x += glm::dvec3(0.0, 0.0, 0.02);  // the RMS is 0.02 m
  const Trajectory reference{state_of(still, 0), state_of(still, 1), state_of(still, 2)};
  const Trajectory run{state_of(still, 0), state_of(one_off, 1), state_of(all_off, 2)};
  EXPECT_NEAR(trajectory_distance(run, reference), 0.05, 1e-15);
  EXPECT_EQ(trajectory_distance(reference, reference), 0.0);
}

TEST(Error, IsInfiniteForWhatCannotBeCompared) {
  const std::vector<glm::dvec3> still(4, glm::dvec3(0.0));
  std::vector<glm::dvec3> broken = still;
  broken[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(trajectory_distance({state_of(broken, 0)}, {state_of(still, 0)})));
  EXPECT_TRUE(std::isinf(trajectory_distance({state_of(still, 0)}, {})));
}

/// A flat cloth put through an affine map: what bilinear interpolation carries exactly.
State affine(const Grid& grid) {
  std::vector<glm::dvec3> x;
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i)
      x.push_back(glm::dvec3(1.0, 0.5, -2.0) * (i * grid.spacing_m) +
                  glm::dvec3(0.3, -1.0, 0.7) * (j * grid.spacing_m));
  return state_of(x, 0);
}

Grid grid_of(std::uint32_t nx, std::uint32_t ny) { return {nx, ny, 1.0 / (nx - 1)}; }

TEST(Resolution, AffineMapsAgreeOnEveryPairOfGrids) {
  const Grid coarse = grid_of(9, 9);
  for (const Grid& fine : {grid_of(17, 17), grid_of(14, 14), grid_of(9, 9), grid_of(30, 30)})
    EXPECT_NEAR(resolution_distance(coarse, affine(coarse), fine, affine(fine)), 0.0, 1e-14) << fine.nx;
}

TEST(Resolution, SharedParticlesAreReadDirectly) {
  const Grid coarse = grid_of(5, 5), fine = grid_of(9, 9);
  State moved = affine(fine);
  // Particles between the shared ones do not count, however far off they are.
  for (std::uint32_t j = 0; j < fine.ny; ++j)
    for (std::uint32_t i = 0; i < fine.nx; ++i)
      if (i % 2 == 1 || j % 2 == 1) moved.position[fine.index(i, j)] += glm::dvec3(7.0);
  EXPECT_NEAR(resolution_distance(coarse, affine(coarse), fine, moved), 0.0, 1e-14);
  for (glm::dvec3& x : moved.position) x += glm::dvec3(0.0, 0.25, 0.0);
  EXPECT_NEAR(resolution_distance(coarse, affine(coarse), fine, moved), 0.25, 1e-14);
}

}  // namespace
}  // namespace weft::study
