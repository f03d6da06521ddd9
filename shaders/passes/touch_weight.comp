#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Weighs the pairs of each particle's list that are nearer than their limit now: contacts divide by it. Keeps
// the state that contacts are computed from, and empties the sums for surface_touch and surface_contact.
// Each invocation writes its own particle's words: no races.

#include "../shared/cells.glsl"
READS(real4, position)
READS(real4, velocity)
READS(uint, pair_count)
READS(uint, pair_places)
UPDATES(uint, collision_state)
WRITES(uint, touch_weight)
WRITES(uint, surface_bound)
WRITES(uint, surface_sums)
WRITES(real4, near_position)
WRITES(real4, near_velocity)

layout(local_size_x = kCollisionGroup) in;

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  real4 own_x = position[own.particle];
  near_position[own.particle] = own_x;
  near_velocity[own.particle] = velocity[own.particle];
  surface_bound[own.particle] = kInfinity;
  for (uint plane = 0u; plane < kSumPlanes; ++plane) surface_sums[plane * c.count + own.particle] = 0u;
  real3 x = own_x.xyz;
  uint entries = pair_count[own.particle], touching = 0u;
  real limit_max = collision[0].limits[c.limit_last].y;
  for (uint k = 0u; k < entries; ++k) {
    uint place = pair_places[k * c.count + own.particle];
    precise real3 d = position[particle_at(c, place)].xyz - x;
    real q = squared_length(d);
    if (q < limit_max && q < collision[0].limits[limit_row(c, own, place)].y) touching += touch_units(1.0);
  }
  touch_weight[own.particle] = touching;
  if (touching != 0u) mark_touching(c);
}
