// Index lists of the cloth's grid and of the unit sphere: which particles make a triangle or a line.
#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace weft {

/// Three indices a triangle, counter-clockwise seen from the front. Cell by cell A = (i,j), (i,j+1), (i+1,j)
/// and B = (i+1,j), (i,j+1), (i+1,j+1); 6·(nx−1)·(ny−1) indices.
std::vector<std::uint32_t> cloth_triangles(const Grid& grid);

/// The same over every `stride`-th particle along both sides and the last one, so that the edges stay.
std::vector<std::uint32_t> cloth_triangles_coarse(const Grid& grid, std::uint32_t stride);

/// The A triangles only: half of them, so that the triangulation shows. 3·(nx−1)·(ny−1) indices.
std::vector<std::uint32_t> cloth_half_triangles(const Grid& grid);

/// Two indices a line: every edge of the triangulation once.
std::vector<std::uint32_t> cloth_lines(const Grid& grid);

/// The latitude–longitude sphere of shaders/draw/ball.glsl.
std::vector<std::uint32_t> ball_triangles();

}  // namespace weft
