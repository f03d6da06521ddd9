#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Of every pair of a particle and a triangle and of two edges that touch: the push apart to their limit, the
// approach that ends, and friction, shared among their particles by weight. What each side is given adds up
// to the same whole number of quanta, so that momentum is kept; sums of whole numbers, added atomically, do
// not depend on the order. Source: Bridson, Fedkiw and Anderson 2002, sections 7.1 and 7.2 (inelastic impulse
// and friction); Mueller et al. 2007, Position based dynamics, section 3.3 (shares); every operation's order
// is docs/float-form.md.

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, near_position)
READS(real4, near_velocity)
READS(uint, surface_count)
READS(uint, surface_pairs)
READS(uint, touch_weight)
UPDATES(uint, surface_sums)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/surface.glsl"
#include "../shared/touching.glsl"

void give(Cells c, uint particle, ivec3 whole) {
  for (uint axis = 0u; axis < 3u; ++axis)
    if (whole[axis] != 0) atomicAdd(surface_sums[axis * c.count + particle], uint(whole[axis]));
}

ivec3 part(real weight, real3 whole) {
  precise real3 scaled = abs(weight) * whole;
  return ivec3(scaled);
}

// Gives the first side `whole` and the second its opposite; what rounding leaves goes to each side's first.
// A triangle's side begins with the second particle.
void give_sides(Cells c, Touching it, real3 whole) {
  ivec3 all = ivec3(whole);
  ivec3 second = part(it.weight.y, whole), third = part(it.weight.z, whole),
        fourth = part(it.weight.w, whole);
  bool edges = it.ends == 2u;
  ivec3 lead = edges ? all - second : all;
  give(c, it.particle.x, lead);
  if (edges) {
    give(c, it.particle.y, second);
    give(c, it.particle.z, fourth - all);
  } else {
    give(c, it.particle.y, (third + fourth) - all);
    give(c, it.particle.z, -third);
  }
  give(c, it.particle.w, -fourth);
}

real3 closing_velocity(Touching it) {
  precise real3 u = it.weight.x * near_velocity[it.particle.x].xyz;
  u = u + it.weight.y * near_velocity[it.particle.y].xyz;
  u = u + it.weight.z * near_velocity[it.particle.z].xyz;
  u = u + it.weight.w * near_velocity[it.particle.w].xyz;
  return u;
}

real inverse_mass(Touching it) {
  precise real sum = (it.weight.x * it.weight.x) * near_position[it.particle.x].w;
  sum = sum + (it.weight.y * it.weight.y) * near_position[it.particle.y].w;
  sum = sum + (it.weight.z * it.weight.z) * near_position[it.particle.z].w;
  sum = sum + (it.weight.w * it.weight.w) * near_position[it.particle.w].w;
  return sum;
}

real divisor_part(Touching it, uint m) {
  precise real weight = abs(it.weight[m]) * near_position[it.particle[m]].w;
  precise real scaled = weight * touching_in(touch_weight[it.particle[m]]);
  return scaled;
}

// The most that all contacts of its particles do to this one, each given as much as this one.
real divisor(Touching it) {
  precise real sum = divisor_part(it, 0u);
  for (uint m = 1u; m < 4u; ++m) sum = sum + divisor_part(it, m);
  return sum;
}

// The change of the relative velocity u that contact with normal n makes: its ends part at `apart`, or
// faster as they are; Coulomb friction.
real3 response(real3 u, real3 n, real apart, real share) {
  real approach = dot3(u, n);
  precise real closing = min(apart - approach, kClosingMost_m_s);
  if (!(closing > 0.0)) return real3(0.0);
  precise real stop = share * closing;
  precise real3 change = stop * n;
  real friction = collision[0].friction;
  if (friction > 0.0) {
    precise real3 along = u - approach * n;
    precise real speed = sqrt(dot3(along, along));
    precise real cut = friction * closing;
    precise real kept = speed > cut ? cut / speed : 1.0;
    precise real taken = share * kept;
    precise real3 drag = taken * along;
    change = change - drag;
  }
  return change;
}

void contact(Cells c, Touching it) {
  real w = inverse_mass(it);
  if (w == 0.0 || !(it.q > kTinyLengthSquared)) return;
  precise real share = 1.0 / max(divisor(it), kWeightMin);
  precise real l = sqrt(it.q);
  precise real inverse = 1.0 / l;
  precise real3 n = it.d * inverse;
  real apart = parting_speed(collision[0].surface_limit_m - l);
  precise real3 kick = response(closing_velocity(it), n, apart, share) * kKickQuantum_1;
  give_sides(c, it, kick);
}

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  uint entries = surface_count[own.particle];
  for (uint k = 0u; k < entries; ++k) {
    Touching it = touching_of(c, own.particle, surface_pairs[k * c.count + own.particle]);
    if (it.q < collision[0].surface_limit_squared_m2) contact(c, it);
  }
}
