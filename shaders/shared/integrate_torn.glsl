// The body of integrate_torn.comp and of its compensated form (f32k), which define COMPENSATED or not.

READS (real4, substeps)
READS (uint, broken_links)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)
#ifdef COMPENSATED
UPDATES(real4, compensation)
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "effects.glsl"
#include "reach.glsl"
#include "force.glsl"
#include "contact.glsl"
#include "kick.glsl"
#include "drift.glsl"

// The links of a line around a particle that exist and are whole: the two before it, the two after it.
struct Whole {
  bool before2, before, after, after2;
};

bool is_whole(bool exists, uint named, uint bit) {
  return exists && (broken_links[exists ? named : 0u] & bit) == 0u;
}

Whole whole_line(uint p, uint place, uint count, uint next, uint bit) {
  return Whole(is_whole(place >= 2u, p - 2u * next, bit), is_whole(place >= 1u, p - next, bit),
               is_whole(place + 1u < count, p, bit), is_whole(place + 2u < count, p + next, bit));
}

// The force on a of a pair that is there; zero where it is not.
real3 force_if(bool there, real3 k, uint a, uint b) {
  return there ? pair_force(k, end_at(a), end_at(b)) : real3(0.0);
}

// A near pair leans on as many bending triples as it has whole neighbours on its line.
real3 near_row(uint line, bool one, bool other) {
  return params.structural[line * 3u + (one ? 1u : 0u) + (other ? 1u : 0u)].xyz;
}

real3 whole_force(uint p, uint i, uint j) {
  uint nx = params.nx, ny = params.ny;
  const bool far_pairs = flex || bending;
  bool left = i >= 1u, right = i + 1u < nx, up = j >= 1u, down = j + 1u < ny;
  uint row_line = up && down ? 0u : 1u, column_line = left && right ? 2u : 3u;
  Whole h = whole_line(p, i, nx, 1u, kLinkAlongI), v = whole_line(p, j, ny, nx, kLinkAlongJ);

  precise real3 P = real3(0.0);
  if (far_pairs) P = force_if(v.before2 && v.before, params.flex[column_line].xyz, p - 2u * nx, p);
  P = P + force_if(v.before, near_row(column_line, v.before2, v.after), p - nx, p);
  if (shear) {
    P = P + force_if(is_whole(up && right, p - nx, kLinkRising), params.shear.xyz, p - nx + 1u, p);
    P = P + force_if(is_whole(up && left, p - nx - 1u, kLinkFalling), params.shear.xyz, p - nx - 1u, p);
  }
  precise real3 F = force_if(v.after, near_row(column_line, v.before, v.after2), p, p + nx);
  F = F - P;
  F = F + force_if(h.after, near_row(row_line, h.before, h.after2), p, p + 1u);
  precise real3 back = real3(0.0);
  if (shear) back = force_if(is_whole(down && left, p - 1u, kLinkRising), params.shear.xyz, p, p + nx - 1u);
  back = back - force_if(h.before, near_row(row_line, h.before2, h.after), p - 1u, p);
  F = F + back;
  if (shear) F = F + force_if(is_whole(down && right, p, kLinkFalling), params.shear.xyz, p, p + nx + 1u);
  if (far_pairs) {
    F = F + force_if(h.after && h.after2, params.flex[row_line].xyz, p, p + 2u);
    F = F - force_if(h.before2 && h.before, params.flex[row_line].xyz, p - 2u, p);
    F = F + force_if(v.after && v.after2, params.flex[column_line].xyz, p, p + 2u * nx);
  }
  return F;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i;
  real4 own = position[p];
  precise real3 x1 = own.xyz;
  precise real3 v = velocity[p].xyz;
  if (!pins || own.w != 0.0) {
    Step s = step_of(row_index * params.row_stride);
    precise real w = own.w * s.inverse_mass;
    v = kicked_at(p, s, v, acceleration(s, whole_force(p, i, j), w));
    x1 = drifted_at(p, s, own.xyz, v);
    if ((spheres || floor_contact) && s.drift > 0.0) touched_at(p, s, own.xyz, x1, v);
    look_for_bodies(own.xyz, x1);
  }
  position_next[p] = real4(x1, own.w);
  velocity_next[p] = real4(v, 0.0);
  tight = asks_links && p == 0u;  // broken links are long: more may break in every substep
  tell_reach();
}
