// Index lists of the cloth's grid and of the unit sphere: which particles make a triangle or a line.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "model/model.h"

namespace weft {

// The lists of the cloth take every `stride`-th particle along both sides, and the last one, so that the
// edges stay.

/// Three indices a triangle, counter-clockwise seen from the front. Cell by cell A = (i,j), (i,j+1), (i+1,j)
/// and B = (i+1,j), (i,j+1), (i+1,j+1); 6·(nx−1)·(ny−1) indices a cloth with a stride of 1.
std::vector<std::uint32_t> cloth_triangles(const Grid& grid, std::uint32_t stride = 1);

/// The A triangles only: half of them, so that the triangulation shows.
std::vector<std::uint32_t> cloth_half_triangles(const Grid& grid, std::uint32_t stride = 1);

/// Two indices a line: every edge of the triangulation once.
std::vector<std::uint32_t> cloth_lines(const Grid& grid, std::uint32_t stride = 1);

/// The smallest stride with at most that many cells along the width.
std::uint32_t stride_for(const Grid& grid, std::uint32_t cells);

/// What of a torn cloth is whole: six indices a cell for its triangles, then six a particle for its lines, in
/// the layout of the buffer torn_mesh; what is torn covers nothing.
std::vector<std::uint32_t> torn_indices(const Grid& grid, std::span<const std::uint32_t> broken_links);

/// The latitude–longitude sphere of shaders/draw/ball.glsl.
std::vector<std::uint32_t> ball_triangles();

}  // namespace weft
