// Index lists, on flat sheets whose areas and counts are known.
#include "render/mesh.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <set>
#include <utility>
#include <vector>

#include "render/sheet.h"

namespace weft::test {
namespace {

Grid grid_5x4() {
  return build_model([] {
           Scene scene;
           scene.cloth.width_m = 1.0;
           scene.cloth.height_m = 0.75;
           scene.cloth.resolution = 5;
           return scene;
         }())
      .grid;
}

State flat(const Grid& grid) {
  State state;
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i)
      state.position.emplace_back(i * grid.spacing_m, -(j * grid.spacing_m), 0.0);
  return state;
}

/// Sum of the signed areas seen from +z, and that no triangle is turned away.
double area_seen_from_front(const std::vector<std::uint32_t>& triangles, const State& state) {
  double area = 0.0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const glm::dvec3& p = state.position[triangles[t]];
    const double z = glm::cross(state.position[triangles[t + 1]] - p, state.position[triangles[t + 2]] - p).z;
    EXPECT_GT(z, 0.0) << "triangle " << t / 3 << " faces away";
    area += 0.5 * z;
  }
  return area;
}

TEST(Mesh, TrianglesCoverTheSheetOnceAndFaceItsFront) {
  const Grid grid = grid_5x4();
  ASSERT_EQ(grid.ny, 4u);
  const auto triangles = cloth_triangles(grid);
  EXPECT_EQ(triangles.size(), 3u * 2u * 4u * 3u);
  EXPECT_NEAR(area_seen_from_front(triangles, flat(grid)), 0.75, 1e-12);
}

TEST(Mesh, ACoarserOneCoversTheSameSheet) {
  const Grid grid = grid_5x4();
  EXPECT_EQ(cloth_triangles(grid, 1), cloth_triangles(grid));
  for (const std::uint32_t stride : {2u, 3u, 4u, 7u}) {  // 4 × 3 cells: some strides do not divide them
    const auto triangles = cloth_triangles(grid, stride);
    const std::uint32_t columns = (4 + stride - 1) / stride, rows = (3 + stride - 1) / stride;
    EXPECT_EQ(triangles.size(), 6u * columns * rows);
    EXPECT_NEAR(area_seen_from_front(triangles, flat(grid)), 0.75, 1e-12) << "stride " << stride;
  }
}

TEST(Mesh, FlatShadingDrawsExactlyHalfOfTheTriangles) {
  const Grid grid = grid_5x4();
  const auto all = cloth_triangles(grid), half = cloth_half_triangles(grid);
  EXPECT_EQ(2 * half.size(), all.size());
  EXPECT_NEAR(area_seen_from_front(half, flat(grid)), 0.375, 1e-12);
  // One a cell: its first vertex is the cell's own, and no cell comes twice.
  std::set<std::uint32_t> cells;
  for (std::size_t t = 0; t < half.size(); t += 3) cells.insert(half[t]);
  EXPECT_EQ(cells.size(), 12u);
}

TEST(Mesh, LinesAreTheTriangulationsEdgesOnce) {
  const Grid grid = grid_5x4();
  std::set<std::pair<std::uint32_t, std::uint32_t>> from_lines, from_triangles;
  const auto ordered = [](std::uint32_t a, std::uint32_t b) {
    return std::pair(std::min(a, b), std::max(a, b));
  };
  const auto lines = cloth_lines(grid), triangles = cloth_triangles(grid);
  for (std::size_t l = 0; l < lines.size(); l += 2)
    EXPECT_TRUE(from_lines.insert(ordered(lines[l], lines[l + 1])).second) << "line " << l / 2 << " twice";
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k)
      from_triangles.insert(ordered(triangles[t + k], triangles[t + (k + 1) % 3]));
  EXPECT_EQ(from_lines, from_triangles);
}

TEST(Mesh, BallIsClosed) {
  // Fold the seam (the last segment is the first) and each pole into one vertex. In a closed surface every
  // edge is then used once in each direction; triangles that shrink to a line at a pole drop out.
  constexpr std::uint32_t kSegments = 64, kRings = 32;
  const auto folded = [](std::uint32_t vertex) {
    const std::uint32_t ring = vertex / (kSegments + 1), segment = vertex % (kSegments + 1) % kSegments;
    return ring == 0 || ring == kRings ? ring * kSegments : ring * kSegments + segment;
  };
  const auto triangles = ball_triangles();
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  std::size_t whole = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const std::uint32_t v[] = {folded(triangles[t]), folded(triangles[t + 1]), folded(triangles[t + 2])};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    ++whole;
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(edges.insert({v[k], v[(k + 1) % 3]}).second);
  }
  EXPECT_EQ(whole, 2u * kSegments * (kRings - 1));
  for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from}));
}

// Of three cloths the lists are those of one, thrice, with no triangle or line from one to the next.
TEST(ClothMesh, joins_no_two_cloths) {
  const Grid one = grid_5x4();
  Grid three = one;
  three.cloths = 3;
  for (const std::uint32_t stride : {1u, 2u})
    for (const auto list : {cloth_triangles, cloth_half_triangles, cloth_lines}) {
      const std::vector<std::uint32_t> alone = list(one, stride), all = list(three, stride);
      ASSERT_EQ(all.size(), 3 * alone.size());
      std::multiset<std::uint32_t> expected, got(all.begin(), all.end());
      for (std::uint32_t cloth = 0; cloth < 3; ++cloth)
        for (const std::uint32_t index : alone) expected.insert(cloth * one.count() + index);
      EXPECT_EQ(got, expected);
      const std::size_t corners = list == cloth_lines ? 2 : 3;
      for (std::size_t k = 0; k < all.size(); ++k)
        EXPECT_EQ(all[k] / one.count(), all[k / corners * corners] / one.count());
    }
}

}  // namespace
}  // namespace weft::test
