// The count of edges that pass through triangles, which other tests rely on.
#include "support/crossings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/layers.h"

namespace weft::testing_support {
namespace {

// The tree finds what looking at all pairs finds, on a crumpled sheet that crosses itself; a flat one does
// not.
TEST(Crossings, are_the_same_by_the_tree_and_by_all_pairs) {
  const LayeredScene sheet = folded_sheet(13, 0.2);
  EXPECT_EQ(crossing_count(sheet.model.grid, sheet.start.position), 0u);
  State crumpled = sheet.start;
  double turn = 0.0;
  for (glm::dvec3& x : crumpled.position) {
    turn += 1.7;
    x += 0.1 * glm::dvec3(std::sin(turn * turn), std::cos(3.0 * turn), std::sin(7.0 * turn));
  }
  const std::size_t all = crossing_count_of_all(sheet.model.grid, crumpled.position);
  EXPECT_GT(all, 100u);
  EXPECT_EQ(crossing_count(sheet.model.grid, crumpled.position), all);
}

// Shewchuk's sum against a determinant that doubles get wrong: 2⁻⁶⁰ beside 1.
TEST(Crossings, know_the_side_of_a_plane_exactly) {
  const glm::dvec3 a{1, 0, 0}, b{0, 1, 0}, c{-1, -1, 0};
  for (const double z : {0x1p-60, -0x1p-60, 0.0}) {
    const int expected = z > 0 ? -1 : (z < 0 ? 1 : 0);
    EXPECT_EQ(side_of_plane_exact(a, b, c, {0.1, 0.1, z}), expected);
    EXPECT_EQ(side_of_plane(a, b, c, {0.1, 0.1, z}), expected);
  }
  // Four points of the plane x + y + z = 0.9 whose coordinates round: the exact sum says on which side.
  const glm::dvec3 d{0.3, 0.3, 0.3}, e{0.1, 0.2, 0.6}, f{0.7, 0.1, 0.1}, g{0.4, 0.2, 0.3};
  EXPECT_EQ(side_of_plane(d, e, f, g), side_of_plane_exact(d, e, f, g));
}

// Whole numbers, whose determinant 128 bits hold: as they are, where differences are exact, and with a far
// fourth point that makes them round. A third of the points lie in a plane.
TEST(Crossings, agree_with_whole_numbers_about_the_side) {
  __extension__ using Wide = __int128;
  std::uint64_t state = 7;
  const auto random = [&](std::int64_t most) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::int64_t>(state >> 33) % (2 * most + 1) - most;
  };
  int flat = 0;
  for (int trial = 0; trial < 30'000; ++trial) {
    std::int64_t p[4][3];
    for (auto& point : p)
      for (auto& x : point) x = random(1 << 20);
    if (trial % 3 == 0)  // p3 = p0 + m (p1 − p0) + n (p2 − p0)
      for (int k = 0, m = static_cast<int>(random(3)); k < 3; ++k)
        p[3][k] = p[0][k] + m * (p[1][k] - p[0][k]) + (trial % 5) * (p[2][k] - p[0][k]);
    if (trial % 4 == 0) p[3][0] = std::int64_t{1} << 60;
    if (trial % 14 == 0) ++p[3][1];
    const auto far = [&](int q, int k) { return Wide{p[q][k]} - p[3][k]; };
    Wide det = 0;
    for (int k = 0; k < 3; ++k)
      det +=
          far(0, k) * (far(1, (k + 1) % 3) * far(2, (k + 2) % 3) - far(1, (k + 2) % 3) * far(2, (k + 1) % 3));
    const auto place = [&](int q) {
      return glm::dvec3(static_cast<double>(p[q][0]), static_cast<double>(p[q][1]),
                        static_cast<double>(p[q][2]));
    };
    const int expected = det > 0 ? 1 : det < 0 ? -1 : 0;
    flat += expected == 0;
    ASSERT_EQ(side_of_plane_exact(place(0), place(1), place(2), place(3)), expected) << trial;
    ASSERT_EQ(side_of_plane(place(0), place(1), place(2), place(3)), expected) << trial;
  }
  EXPECT_GT(flat, 1000);
}

}  // namespace
}  // namespace weft::testing_support
