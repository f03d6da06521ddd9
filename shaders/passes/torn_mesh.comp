#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"
#include "../shared/links.h"

// The index list of a torn cloth: two triangles a cell, then three lines a particle. What is torn, or beyond
// the edge, has the same index throughout and covers nothing.
// Each invocation writes the indices of its own particle and cell: no races.

READS (uint, broken_links)
WRITES(uint, torn_mesh)

layout(local_size_x = 64) in;

void put_triangle(uint at, bool whole, uint a, uint b, uint c) {
  torn_mesh[at] = a;
  torn_mesh[at + 1u] = whole ? b : a;
  torn_mesh[at + 2u] = whole ? c : a;
}

void put_line(uint at, bool whole, uint a, uint b, uint own) {
  torn_mesh[at] = whole ? a : own;
  torn_mesh[at + 1u] = whole ? b : own;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, nx = params.nx, ny = params.ny;
  if (i >= nx || j >= ny) return;
  uint p = j * nx + i, links = broken_links[p];
  bool right = i + 1u < nx, below = j + 1u < ny, cell = right && below;
  if (cell) {
    uint at = 6u * (j * (nx - 1u) + i);
    uint b_edges = links & kLinkRising;
    b_edges |= (broken_links[p + 1u] & kLinkAlongJ) | (broken_links[p + nx] & kLinkAlongI);
    put_triangle(at, (links & (kLinkAlongI | kLinkAlongJ | kLinkRising)) == 0u, p, p + nx, p + 1u);
    put_triangle(at + 3u, b_edges == 0u, p + 1u, p + nx, p + nx + 1u);
  }
  uint at = 6u * ((nx - 1u) * (ny - 1u) + p);
  put_line(at, right && (links & kLinkAlongI) == 0u, p, p + 1u, p);
  put_line(at + 2u, below && (links & kLinkAlongJ) == 0u, p, p + nx, p);
  put_line(at + 4u, cell && (links & kLinkRising) == 0u, p + 1u, p + nx, p);
}
