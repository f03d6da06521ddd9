#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Asks whether the pair lists still hold: a particle that has moved more than half the skin, seen from the
// cloth's middle, makes them stale. Also empties the grid for the passes that would make them anew.
// Each invocation clears its own words; all that find the lists stale write the same answer, the workgroups
// of the indirect dispatches that follow: no order matters.
// Source: Verlet 1967 (lists with a margin); docs/effects.md "Self-collision".

#include "../shared/cells.glsl"
READS  (real4, position)
READS  (real4, built_position)
UPDATES(uint, collision_state)
WRITES (uint, cells)

layout(local_size_x = kCollisionGroup) in;

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  uint count = c.count, centre = collision[0].centre;
  cells[own.particle] = 0u;
  if (own.particle + count <= collision[0].bucket_mask + 1u) cells[own.particle + count] = 0u;
  precise real3 moved = position[own.particle].xyz - built_position[own.particle].xyz;
  precise real3 drifted = position[centre].xyz - built_position[centre].xyz;
  precise real3 relative = moved - drifted;
  bool holds = squared_length(relative) <= collision[0].moved_squared_max_m2;
  if (holds) return;
  atomicOr(collision_state[kListGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup);
  atomicOr(collision_state[kScanGroups], 1u);
}
