#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Takes the approach of pairs that are nearer than their limit and makes them part, in one Jacobi step. A
// pair's share is one over the most that all contacts of its two particles together can do to it, so that
// nothing is ever corrected more than once over, and what one end gains the other loses.
// Adds what surfaces have given the particle. It reads the state that touch_weight kept and writes its own
// particle: no races.
// Source: docs/physics.md "Self-collision"; every operation's order is docs/float-form.md.

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, near_position)
READS(real4, near_velocity)
READS(uint, pair_count)
READS(uint, pair_places)
READS(uint, touch_weight)
READS(uint, surface_sums)
UPDATES(uint, collision_state)
WRITES(real4, velocity)

layout(local_size_x = kCollisionGroup) in;

const uint kNone = 0xffffffffu;

// The smallest place above `last` that touches the particle (with 0 taken as above `last` when first).
uint next_touching(Cells c, Own own, real3 x, uint entries, bool first, uint last) {
  uint next = kNone;
  real limit_max = collision[0].limits[c.limit_last].y;
  for (uint k = 0u; k < entries; ++k) {
    uint place = pair_places[k * c.count + own.particle];
    if (place >= next || (!first && place <= last)) continue;
    precise real3 d = near_position[particle_at(c, place)].xyz - x;
    real q = squared_length(d);
    if (q < limit_max && q < collision[0].limits[limit_row(c, own, place)].y) next = place;
  }
  return next;
}

// Adds what the pair (own, other) gives the particle.
void add_pair(Cells c, Own own, real4 x, real3 v, real touching, uint place, inout real3 kick) {
  uint other = particle_at(c, place);
  real4 there = near_position[other];
  precise real w = x.w + there.w;
  if (w == 0.0) return;
  precise real mine = x.w * touching, its = there.w * touching_in(touch_weight[other]);
  precise real share = x.w / (mine + its);
  precise real3 d = there.xyz - x.xyz;
  precise real q = squared_length(d);
  precise real l = 0.0;
  precise real3 n = real3(0.0, own.place < place ? 1.0 : -1.0, 0.0);  // of coincident particles
  if (q > kTinyLengthSquared) {
    l = sqrt(q);
    precise real inverse = 1.0 / l;
    n = d * inverse;
  }
  real apart = parting_speed(collision[0].limits[limit_row(c, own, place)].x - l);
  precise real3 dv = near_velocity[other].xyz - v;
  real approach = dot3(dv, n);
  precise real closing = apart - approach;
  if (closing > 0.0) {
    precise real taken = share * closing;
    precise real3 stop = taken * n;
    kick = kick - stop;
    if (collision[0].friction > 0.0) {
      precise real3 along = dv - approach * n;
      precise real speed = sqrt(dot3(along, along));
      precise real cut = collision[0].friction * closing;
      precise real kept = speed > cut ? cut / speed : 1.0;
      precise real rubbed = share * kept;
      precise real3 drag = rubbed * along;
      kick = kick + drag;
    }
  }
}

real3 summed(Cells c, uint particle) {
  ivec3 whole;
  for (uint axis = 0u; axis < 3u; ++axis)
    whole[axis] = int(surface_sums[axis * c.count + particle]);
  precise real3 sum = real3(whole) * (1.0 / kKickQuantum_1);
  return sum;
}

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  if (own.particle == 0u) collision_state[kTouchGroups] = 0u;  // done: nothing is due
  real4 x = near_position[own.particle];
  uint touching = touch_weight[own.particle];
  if (touching == 0u || x.w == 0.0) return;
  real3 v = near_velocity[own.particle].xyz;
  uint entries = pair_count[own.particle], last = 0u;
  precise real3 kick = x.w * summed(c, own.particle);
  for (uint turn = 0u; turn < entries; ++turn) {
    last = next_touching(c, own, x.xyz, entries, turn == 0u, last);
    if (last == kNone) break;
    add_pair(c, own, x, v, touching_in(touching), last, kick);
  }
  precise real3 v1 = v + kick;
  velocity[own.particle] = real4(v1, 0.0);
}
