// Self-collision's grid and places: docs/float-form.md "Self-collision". The including pass includes
// pass.glsl first.
#include "collision.h"
#include "sheets.glsl"

READS(Collision, collision)

// What is the same for all invocations, read once: a software device pays for every load.
struct Cells {
  uint nx, ny, count, column_bits, bucket_mask, limit_last;
  real inverse_cell_1_m;
};

Cells cells_of_cloth() {
  Cells c;
  c.nx = params.nx;
  c.ny = params.ny;
  c.count = c.nx * c.ny;
  c.column_bits = collision[0].column_bits;
  c.bucket_mask = collision[0].bucket_mask;
  c.limit_last = collision[0].limit_last;
  c.inverse_cell_1_m = collision[0].inverse_cell_1_m;
  return c;
}

// Where this invocation's particle is.
struct Own {
  uint i, j, particle, place;
};

bool own_particle(Cells c, out Own own) {
  own.i = gl_GlobalInvocationID.x;
  own.j = gl_GlobalInvocationID.y;
  own.particle = own.j * c.nx + own.i;
  own.place = (own.j << c.column_bits) | own.i;
  return own.i < c.nx && own.j < c.ny;
}

uvec2 column_and_row(Cells c, uint place) {
  return uvec2(place & ((1u << c.column_bits) - 1u), place >> c.column_bits);
}

uint particle_at(Cells c, uint place) {
  uvec2 ij = column_and_row(c, place);
  return ij.y * c.nx + ij.x;
}

Own own_at(Cells c, uint place) {
  uvec2 ij = column_and_row(c, place);
  return Own(ij.x, ij.y, ij.y * c.nx + ij.x, place);
}

// What a contact adds to touch_weight of a particle that moves by `weight` of it; never nothing.
uint touch_units(real weight) {
  precise real units = weight * real(kTouchQuantum_1);
  return uint(units) + 1u;
}

// What touch_weight adds up to.
real touching_in(uint units) {
  precise real sum = real(units) * (1.0 / real(kTouchQuantum_1));
  return sum;
}

// Says that something touches: contacts are to be computed. For passes that update collision_state.
#define mark_touching(c) \
  atomicOr(collision_state[kTouchGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup)

// The speed at which contacts that overlap by `depth` are to part.
real parting_speed(real depth) {
  precise real speed = min(max(depth, 0.0), collision[0].deep_m) * collision[0].recover_1_s;
  return speed;
}

// Whether the grid covers the place: not when it is too far away, or no number.
bool covered(Cells c, real3 x) {
  precise real3 scaled = x * c.inverse_cell_1_m;
  return abs(scaled.x) < kCellsFromOriginMax && abs(scaled.y) < kCellsFromOriginMax &&
         abs(scaled.z) < kCellsFromOriginMax;
}

// Source: Teschner et al. 2003, Optimized spatial hashing for collision detection, section 3.
uint bucket_of(Cells c, ivec3 cell) {
  uvec3 u = uvec3(cell);
  return ((u.x * 73856093u) ^ (u.y * 19349663u) ^ (u.z * 83492791u)) & c.bucket_mask;
}

// The row of `limits` that holds for a pair of places.
uint limit_row(Cells c, Own own, uint place) {
  uvec2 other = column_and_row(c, place);
  if (sheet_rows != 0u && other.y / sheet_rows != own.j / sheet_rows) return c.limit_last;  // two cloths
  int di = min(abs(int(other.x) - int(own.i)), kOffsetMax);
  int dj = min(abs(int(other.y) - int(own.j)), kOffsetMax);
  return min(uint(di * di + dj * dj), c.limit_last);
}

real squared_length(real3 d) {
  precise real q = (d.x * d.x + d.y * d.y) + d.z * d.z;
  return q;
}
