#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// First third of the counting sort: how many particles each bucket of the grid holds.
// Counts are integers added atomically: their sums do not depend on the order.
// Source: Green 2008, Particle simulation using CUDA, "Building the grid using atomic operations".

#include "../shared/cells.glsl"
READS  (real4, position)
READS  (uint, collision_state)
WRITES (real4, built_position)
UPDATES(uint, cells)

layout(local_size_x = kCollisionGroup) in;

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  real4 x = position[own.particle];
  built_position[own.particle] = x;
  atomicAdd(cells[bucket_of(c, cell_of(c, x.xyz, own.particle))], 1u);
}
