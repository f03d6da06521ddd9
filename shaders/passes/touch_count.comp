#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// How many pairs of each particle's list are nearer than their limit now. self_contact divides by it.
// From here on the lists are fresh.

#include "../shared/cells.glsl"
READS  (real4, position)
READS  (uint, pair_count)
READS  (uint, pair_places)
UPDATES(uint, collision_state)
WRITES (uint, touch_count)

layout(local_size_x = kCollisionGroup) in;

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  if (own.particle == 0u) collision_state[kListGroups] = collision_state[kScanGroups] = 0u;
  real3 x = position[own.particle].xyz;
  uint entries = pair_count[own.particle], touching = 0u;
  real limit_max = collision[0].limits[c.limit_last].y;
  for (uint k = 0u; k < entries; ++k) {
    uint place = pair_places[k * c.count + own.particle];
    precise real3 d = position[particle_at(c, place)].xyz - x;
    real q = squared_length(d);
    if (q < limit_max && q < collision[0].limits[limit_row(c, own, place)].y) ++touching;
  }
  touch_count[own.particle] = touching;
}
