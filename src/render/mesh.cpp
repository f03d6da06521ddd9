// Index lists, generated.
#include "render/mesh.h"

#include <algorithm>

#include "passes/passes.h"
#include "passes/tearing.h"

namespace weft {
namespace {

// The same numbers as in shaders/draw/ball.glsl, which makes the vertices.
constexpr std::uint32_t kBallSegments = 64, kBallRings = 32;

/// Every stride-th of `count` lines of particles, and the last.
std::vector<std::uint32_t> kept(std::uint32_t count, std::uint32_t stride) {
  std::vector<std::uint32_t> lines;
  for (std::uint32_t k = 0; k + 1 < count; k += stride) lines.push_back(k);
  lines.push_back(count - 1);
  return lines;
}

/// The same of every cloth's rows.
std::vector<std::uint32_t> kept_rows(const Grid& grid, std::uint32_t stride) {
  const std::vector<std::uint32_t> own = kept(grid.ny, stride);
  std::vector<std::uint32_t> rows;
  for (std::uint32_t cloth = 0; cloth < grid.cloths; ++cloth)
    for (const std::uint32_t row : own) rows.push_back(cloth * grid.ny + row);
  return rows;
}

bool is_last_row(const Grid& grid, std::uint32_t row) { return grid.own_row(row) + 1 == grid.ny; }

}  // namespace

std::vector<std::uint32_t> cloth_triangles(const Grid& grid, std::uint32_t stride) {
  std::vector<std::uint32_t> indices;
  const std::vector<std::uint32_t> columns = kept(grid.nx, stride), rows = kept_rows(grid, stride);
  indices.reserve(std::size_t{6} * (columns.size() - 1) * (rows.size() - grid.cloths));
  for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
    if (is_last_row(grid, rows[j])) continue;
    for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
      const std::uint32_t own = grid.index(columns[i], rows[j]), right = grid.index(columns[i + 1], rows[j]),
                          below = grid.index(columns[i], rows[j + 1]),
                          last = grid.index(columns[i + 1], rows[j + 1]);
      for (const std::uint32_t index : {own, below, right, right, below, last}) indices.push_back(index);
    }
  }
  return indices;
}

std::vector<std::uint32_t> cloth_half_triangles(const Grid& grid, std::uint32_t stride) {
  const std::vector<std::uint32_t> all = cloth_triangles(grid, stride);
  std::vector<std::uint32_t> indices;
  indices.reserve(all.size() / 2);
  for (std::size_t cell = 0; cell < all.size(); cell += 6)
    indices.insert(indices.end(), all.begin() + static_cast<std::ptrdiff_t>(cell),
                   all.begin() + static_cast<std::ptrdiff_t>(cell) + 3);
  return indices;
}

std::vector<std::uint32_t> cloth_lines(const Grid& grid, std::uint32_t stride) {
  std::vector<std::uint32_t> indices;
  const std::vector<std::uint32_t> columns = kept(grid.nx, stride), rows = kept_rows(grid, stride);
  indices.reserve(std::size_t{6} * columns.size() * rows.size());
  const auto line = [&](std::uint32_t a, std::uint32_t b) {
    indices.push_back(a);
    indices.push_back(b);
  };
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const bool has_right = i + 1 < columns.size(), has_below = !is_last_row(grid, rows[j]);
      const std::uint32_t own = grid.index(columns[i], rows[j]);
      if (has_right) line(own, grid.index(columns[i + 1], rows[j]));
      if (has_below) line(own, grid.index(columns[i], rows[j + 1]));
      if (has_right && has_below)
        line(grid.index(columns[i + 1], rows[j]), grid.index(columns[i], rows[j + 1]));
    }
  return indices;
}

std::uint32_t stride_for(const Grid& grid, std::uint32_t cells) {
  return std::max(1u, (grid.nx - 1 + cells - 1) / cells);
}

std::vector<std::uint32_t> torn_indices(const Grid& grid, std::span<const std::uint32_t> broken_links) {
  HostBuffers<float> host;
  host.words_of(BufferId::broken_links).assign(broken_links.begin(), broken_links.end());
  host.words_of(BufferId::torn_mesh).resize(torn_mesh_words(grid));
  Model model;
  model.grid = grid;
  torn_mesh.mirror_f32({model, {}, KickDrift{}, 0}, host);
  return host.words_of(BufferId::torn_mesh);
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
