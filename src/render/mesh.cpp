// Index lists, generated.
#include "render/mesh.h"

#include <algorithm>

namespace weft {
namespace {

// The same numbers as in shaders/draw/ball.glsl, which makes the vertices.
constexpr std::uint32_t kBallSegments = 64, kBallRings = 32;

}  // namespace

std::vector<std::uint32_t> cloth_triangles(const Grid& grid) {
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{6} * (grid.nx - 1) * (grid.ny - 1));
  for (std::uint32_t j = 0; j + 1 < grid.ny; ++j)
    for (std::uint32_t i = 0; i + 1 < grid.nx; ++i) {
      const std::uint32_t a = grid.index(i, j), right = a + 1, below = a + grid.nx;
      for (const std::uint32_t index : {a, below, right, right, below, below + 1}) indices.push_back(index);
    }
  return indices;
}

std::vector<std::uint32_t> cloth_triangles_coarse(const Grid& grid, std::uint32_t stride) {
  std::vector<std::uint32_t> indices;
  const auto next = [&](std::uint32_t k, std::uint32_t count) { return std::min(k + stride, count - 1); };
  for (std::uint32_t j = 0; j + 1 < grid.ny; j = next(j, grid.ny))
    for (std::uint32_t i = 0; i + 1 < grid.nx; i = next(i, grid.nx)) {
      const std::uint32_t a = grid.index(i, j), right = grid.index(next(i, grid.nx), j),
                          below = grid.index(i, next(j, grid.ny)),
                          last = grid.index(next(i, grid.nx), next(j, grid.ny));
      for (const std::uint32_t index : {a, below, right, right, below, last}) indices.push_back(index);
    }
  return indices;
}

std::vector<std::uint32_t> cloth_half_triangles(const Grid& grid) {
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{3} * (grid.nx - 1) * (grid.ny - 1));
  for (std::uint32_t j = 0; j + 1 < grid.ny; ++j)
    for (std::uint32_t i = 0; i + 1 < grid.nx; ++i) {
      const std::uint32_t a = grid.index(i, j);
      for (const std::uint32_t index : {a, a + grid.nx, a + 1}) indices.push_back(index);
    }
  return indices;
}

std::vector<std::uint32_t> cloth_lines(const Grid& grid) {
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{6} * grid.count());
  const auto line = [&](std::uint32_t a, std::uint32_t b) {
    indices.push_back(a);
    indices.push_back(b);
  };
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i) {
      const std::uint32_t own = grid.index(i, j);
      if (i + 1 < grid.nx) line(own, own + 1);
      if (j + 1 < grid.ny) line(own, own + grid.nx);
      if (i + 1 < grid.nx && j + 1 < grid.ny) line(own + 1, own + grid.nx);
    }
  return indices;
}

std::vector<std::uint32_t> ball_triangles() {
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{6} * kBallSegments * kBallRings);
  for (std::uint32_t ring = 0; ring < kBallRings; ++ring)
    for (std::uint32_t segment = 0; segment < kBallSegments; ++segment) {
      const std::uint32_t a = ring * (kBallSegments + 1) + segment, below = a + kBallSegments + 1;
      for (const std::uint32_t index : {a, below, a + 1, a + 1, below, below + 1}) indices.push_back(index);
    }
  return indices;
}

}  // namespace weft
