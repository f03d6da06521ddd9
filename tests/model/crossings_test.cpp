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

}  // namespace
}  // namespace weft::testing_support
