#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Pushes pairs that are nearer than their limit apart to it, and takes their approach: both in one Jacobi
// step, every pair weighted by the busier of its two particles, so that what one particle is given never adds
// up to more than one whole correction, and what one end gains the other loses.
// Each invocation writes its own particle of the *_next buffers and reads only the others: no races.
// Source: docs/physics.md "Self-collision"; every operation's order is docs/float-form.md.

#include "../shared/cells.glsl"
READS (real4, position)
READS (real4, velocity)
READS (uint, pair_count)
READS (uint, pair_places)
READS (uint, touch_count)
WRITES(real4, position_next)
WRITES(real4, velocity_next)

layout(local_size_x = kCollisionGroup) in;

const uint kNone = 0xffffffffu;

// The smallest place above `last` that touches the particle (with 0 taken as above `last` when first).
uint next_touching(Cells c, Own own, real3 x, uint entries, bool first, uint last) {
  uint next = kNone;
  real limit_max = collision[0].limits[c.limit_last].y;
  for (uint k = 0u; k < entries; ++k) {
    uint place = pair_places[k * c.count + own.particle];
    if (place >= next || (!first && place <= last)) continue;
    precise real3 d = position[particle_at(c, place)].xyz - x;
    real q = squared_length(d);
    if (q < limit_max && q < collision[0].limits[limit_row(c, own, place)].y) next = place;
  }
  return next;
}

// Adds what the pair (own, other) gives the particle.
void add_pair(Cells c, Own own, real4 x, real3 v, real touching, uint place, inout real3 push,
              inout real3 kick) {
  uint other = particle_at(c, place);
  real4 there = position[other];
  precise real w = x.w + there.w;
  if (w == 0.0) return;
  precise real share = x.w / w;
  share = share / max(touching, real(touch_count[other]));
  precise real3 d = there.xyz - x.xyz;
  precise real q = squared_length(d);
  precise real l = 0.0;
  precise real3 n = real3(0.0, own.place < place ? 1.0 : -1.0, 0.0);  // of coincident particles
  if (q > kTinyLengthSquared) {
    l = sqrt(q);
    precise real inverse = 1.0 / l;
    n = d * inverse;
  }
  precise real depth = max(collision[0].limits[limit_row(c, own, place)].x - l, 0.0);
  precise real far = share * depth;
  precise real3 away = far * n;
  push = push - away;
  precise real3 dv = velocity[other].xyz - v;
  precise real closing = (dv.x * n.x + dv.y * n.y) + dv.z * n.z;
  if (closing < 0.0) {
    precise real taken = share * closing;
    precise real3 stop = taken * n;
    kick = kick + stop;
  }
}

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  real4 x = position[own.particle], v = velocity[own.particle];
  uint touching = touch_count[own.particle];
  if (touching > 0u && x.w != 0.0) {
    uint entries = pair_count[own.particle], last = 0u;
    precise real3 push = real3(0.0), kick = real3(0.0);
    for (uint turn = 0u; turn < touching; ++turn) {
      last = next_touching(c, own, x.xyz, entries, turn == 0u, last);
      if (last == kNone) break;
      add_pair(c, own, x, v.xyz, real(touching), last, push, kick);
    }
    precise real3 x1 = x.xyz + push;
    precise real3 v1 = v.xyz + kick;
    x = real4(x1, x.w);
    v = real4(v1, v.w);
  }
  position_next[own.particle] = x;
  velocity_next[own.particle] = real4(v.xyz, 0.0);
}
