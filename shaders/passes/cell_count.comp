#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// First third of the counting sort: how many particles each bucket of the grid holds. And the longest edge,
// by which surface_gather knows how far to look. Counts are integers added atomically: their sums do not
// depend on the order, nor does the greatest. Source: Green 2008, Particle simulation using CUDA, "Building
// the grid using atomic operations".

#include "../shared/cells.glsl"
READS(real4, position)
UPDATES(uint, collision_state)
WRITES(real4, built_position)
UPDATES(uint, cells)

layout(local_size_x = kCollisionGroup) in;

// The longest squared edge from the particle to the right, below, and below to the left.
real longest_edge(Cells c, Own own, real3 x) {
  bool right = own.i + 1u < c.nx, below = own_row(own.j) + 1u < rows_of_cloth();
  uint p = own.particle;
  precise real3 d0 = position[right ? p + 1u : p].xyz - x;
  precise real3 d1 = position[below ? p + c.nx : p].xyz - x;
  precise real3 d2 = position[below && own.i > 0u ? p + c.nx - 1u : p].xyz - x;
  return max(max(squared_length(d0), squared_length(d1)), squared_length(d2));
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  real4 x = position[own.particle];
  built_position[own.particle] = x;
  uint longest = floatBitsToUint(float(longest_edge(c, own, x.xyz)));
  if (longest > collision_state[kLongestEdge]) atomicMax(collision_state[kLongestEdge], longest);
  atomicAdd(cells[bucket_of(c, cell_of(c, x.xyz, own.particle))], 1u);
}
