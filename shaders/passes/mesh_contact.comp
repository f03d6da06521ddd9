#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Contact with meshes, given as distances on grids, and then the floor, which always holds, after a drift
// that began where position_next still says.
// Each invocation reads and writes its own particle only: no races.
// Source: docs/physics.md "Contact"; every operation's order is docs/float-form.md.

READS (real4, substeps)
READS (uint, distance_grids)
READS (real4, position_next)
UPDATES(real4, position)
UPDATES(real4, velocity)
#ifdef WEFT_REACH
#include "../shared/reach.h"
UPDATES(uint, reach_groups)
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };

layout(constant_id = 0) const uint meshes = 1u;
layout(constant_id = 1) const uint mesh_rows = 2u;  // where they begin in the row
layout(constant_id = 2) const bool level_floor = true;
layout(constant_id = 3) const uint tilted_floor = 0u;  // where it stands in the row; 0: there is none
#include "../shared/dot.glsl"
#include "../shared/cross.glsl"
#include "../shared/respond.glsl"
#include "../shared/solid.glsl"
#include "../shared/ground.glsl"

struct Samples {
  real3 low, last;  // lowest corner [m]; index of the last sample along each axis
  real cell_m, reach;
  uint first, nx, ny;
};

Samples samples_of(uint row) {
  real4 corner = substeps[row + 10u], count = substeps[row + 11u];
  return Samples(corner.xyz, count.xyz - real3(1.0), corner.w, substeps[row].w, uint(count.w), uint(count.x),
                 uint(count.y));
}

real distance_sample(uint k) { return real(uintBitsToFloat(distance_grids[k])); }

// Trilinear between eight samples, and the gradient of that in a unit vector.
Near near_mesh(Samples g, real3 p) {
  precise real3 q = (p - g.low) / g.cell_m;
  q = min(max(q, real3(0.0)), g.last);
  real3 low = min(floor(q), g.last - real3(1.0));
  precise real3 t = q - low;
  uint k = g.first + (uint(low.z) * g.ny + uint(low.y)) * g.nx + uint(low.x), layer = g.nx * g.ny;
  real d000 = distance_sample(k), d100 = distance_sample(k + 1u);
  real d010 = distance_sample(k + g.nx), d110 = distance_sample(k + g.nx + 1u);
  real d001 = distance_sample(k + layer), d101 = distance_sample(k + layer + 1u);
  real d011 = distance_sample(k + layer + g.nx), d111 = distance_sample(k + layer + g.nx + 1u);
  precise real x00 = d100 - d000, x10 = d110 - d010, x01 = d101 - d001, x11 = d111 - d011;
  precise real e00 = d000 + t.x * x00, e10 = d010 + t.x * x10, e01 = d001 + t.x * x01, e11 = d011 + t.x * x11;
  precise real y0 = e10 - e00, y1 = e11 - e01;
  precise real f0 = e00 + t.y * y0, f1 = e01 + t.y * y1;
  precise real z = f1 - f0;
  precise real d = f0 + t.z * z;
  precise real gx0 = x00 + t.y * (x10 - x00), gx1 = x01 + t.y * (x11 - x01);
  precise real gx = gx0 + t.z * (gx1 - gx0);
  precise real gy = y0 + t.z * (y1 - y0);
  precise real3 slope = real3(gx, gy, z);
  precise real l = sqrt(dot3(slope, slope));
  Near near;
  near.n = real3(0.0, 1.0, 0.0);
  if (l > kNoLength) {
    precise real inverse = 1.0 / l;
    near.n = slope * inverse;
  }
  precise real above = d - g.reach;
  near.d = above;
  return near;
}

// Whether p lies in the grid, where alone distances are known.
bool in_grid(Samples g, real3 p) {
  precise real3 q = (p - g.low) / g.cell_m;
  return all(greaterThanEqual(q, real3(0.0))) && all(lessThanEqual(q, g.last));
}

// The part of the path from p0 along D that lies in the grid's box: t in [from, to].
bool clipped(Samples g, real3 p0, real3 D, inout real from, inout real to) {
  precise real3 high = g.low + g.last * g.cell_m;
  for (int axis = 0; axis < 3; ++axis) {
    if (D[axis] == 0.0) {
      if (p0[axis] < g.low[axis] || p0[axis] > high[axis]) return false;
    } else {
      precise real a = (g.low[axis] - p0[axis]) / D[axis];
      precise real b = (high[axis] - p0[axis]) / D[axis];
      from = max(from, min(a, b));
      to = min(to, max(a, b));
    }
  }
  return from <= to;
}

// Follows the path in steps as long as the distance says nothing is nearer, and half a cell at least, until
// it is deep; `outside` is the place before, `inside` the one that is deep.
bool goes_deep(Samples g, real3 p0, real3 D, real deep, real to, inout real outside, inout real inside) {
  precise real speed = sqrt(dot3(D, D));
  precise real half_cell = real(0.5) * g.cell_m;
  real t = outside;
  for (uint k = 0u; k < kMeshMarchSteps; ++k) {
    precise real3 way = t * D;
    precise real3 p = p0 + way;
    real d = near_mesh(g, p).d;
    inside = t;
    if (d < -deep) return k > 0u;
    if (t >= to) return false;
    outside = t;
    precise real on = max(d, half_cell) / speed;
    precise real next = t + on;
    t = min(next, to);
  }
  return false;
}

// Where the path came in from outside, when it went deep.
bool enters_mesh(Samples g, real3 p0, real3 D, real deep, inout real entry) {
  real from = 0.0, to = 1.0;
  if (!clipped(g, p0, D, from, to)) return false;
  real outside = from, inside = from;
  if (!goes_deep(g, p0, D, deep, to, outside, inside)) return false;
  for (uint b = 0u; b < kMeshBisections; ++b) {
    precise real between = outside + inside;
    precise real middle = real(0.5) * between;
    precise real3 way = middle * D;
    precise real3 p = p0 + way;
    bool still_outside = near_mesh(g, p).d > 0.0;
    outside = still_outside ? middle : outside;
    inside = still_outside ? inside : middle;
  }
  entry = outside;
  return true;
}

// Puts x1 where p comes to on the surface, and takes the approach from v; p is then the surface there.
void mesh_respond(uint row, Samples g, inout real3 p, out real3 normal, inout real3 x1, inout real3 v) {
  Near near = near_mesh(g, p);
  for (uint k = 0u; k < kMeshProjections; ++k) {  // the distance between samples is not quite one
    precise real3 inwards = near.d * near.n;
    p = p - inwards;
    near = near_mesh(g, p);
  }
  touch_solid(row, p, near, x1, v);
  precise real3 inwards = near.d * near.n;
  precise real3 surface = p - inwards;
  p = surface;
  normal = near.n;
}

// A path that goes deep is turned aside where it enters, and followed once more from there along the tangent
// plane; a second time it ends where it enters.
void mesh_touch(uint row, real3 x0, inout real3 x1, inout real3 v) {
  Samples g = samples_of(row);
  precise real3 come = x0 - substeps[row + 1u].xyz;
  precise real3 gone = x1 - substeps[row].xyz;
  precise real half_cell = real(0.5) * g.cell_m;
  real3 from = in_frame(row + 7u, come), to = in_frame(row + 4u, gone), normal;
  for (uint turn = 0u; turn < 2u; ++turn) {
    precise real3 D = to - from;
    precise real dd = dot3(D, D);
    real entry = 0.0;
    if (!(dd > half_cell * half_cell && enters_mesh(g, from, D, substeps[row + 2u].w, entry))) {
      if (in_grid(g, to) && near_mesh(g, to).d < 0.0) mesh_respond(row, g, to, normal, x1, v);
      return;
    }
    precise real3 way = entry * D;
    precise real3 met = from + way;
    from = met;
    mesh_respond(row, g, from, normal, x1, v);
    if (turn == 1u) return;
    precise real3 beyond = to - from;
    precise real3 up = min(dot3(beyond, normal), real(0.0)) * normal;
    precise real3 slid = to - up;
    to = slid;
    precise real3 stopped = substeps[row].xyz + in_world(row + 4u, to);
    x1 = stopped;
  }
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i, row = row_index * params.row_stride;
#ifdef WEFT_REACH
  if (p == 0u) reach_groups[kReachMeshes] = 0u;  // done: it asks for the next substep alone
#endif
  real4 own = position[p];
  if (own.w == 0.0) return;
  real3 x0 = position_next[p].xyz, x1 = own.xyz, v = velocity[p].xyz;
  for (uint m = 0u; m < meshes; ++m) mesh_touch(row + mesh_rows + m * kRowMeshVec4s, x0, x1, v);
  if (level_floor) level_touch(x1, v);
  if (tilted_floor != 0u) tilted_touch(substeps[row + tilted_floor], x1, v);
  if (x1 == own.xyz && v == velocity[p].xyz) return;
  position[p] = real4(x1, own.w);
  velocity[p] = real4(v, 0.0);
}
