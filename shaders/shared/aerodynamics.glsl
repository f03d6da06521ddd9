// The body of aerodynamics.comp and of aerodynamics_torn.comp, which defines TORN.

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };

layout(constant_id = 0) const uint air_rows = 2u;  // where they begin in the row
layout(constant_id = 1) const bool noise = false;
layout(constant_id = 2) const uint seed = 0u;
#include "dot.glsl"
#include "cross.glsl"
#include "wind_noise.glsl"
#include "sheets.glsl"
#include "whole_triangles.glsl"

struct Corner {
  real3 x, v;
};
struct Push3 {
  real3 force;  // [N]
  real rate;    // force over speed that bounds it [kg/s]
};

Corner corner_at(uint p) { return Corner(position[p].xyz, velocity[p].xyz); }

// Adds a third of the triangle's force in wind w; drag and lift are ½·density·coefficient/6.
void add_triangle(Corner a, Corner b, Corner c, real3 w, real drag, real lift, inout Push3 sum) {
  precise real3 N = cross3(b.x - a.x, c.x - a.x);
  precise real3 v = (a.v + b.v) + c.v;
  v = v / 3.0;
  precise real3 u = w - v;
  precise real L = sqrt(dot3(N, N));
  precise real s = sqrt(dot3(u, u));
  if (!(L > kNoNormal) || !(s > kNoLength)) return;
  precise real d = dot3(u, N);
  precise real un = d / L;
  precise real along = drag * abs(d);
  precise real turned = d * un;
  turned = turned / s;
  turned = lift * turned;
  along = along - turned;
  precise real across = lift * s;
  across = across * un;
  precise real3 first = along * u;
  precise real3 second = across * N;
  precise real3 force = first + second;
  sum.force = sum.force + force;
  precise real rate = (drag + lift) * s;
  rate = rate * L;
  sum.rate = sum.rate + rate;
}

// The whole triangles in the order of docs/float-form.md "Vertex normals".
Push3 air_force(uint i, uint j, Corner own, real3 w, real drag, real lift) {
  uint nx = params.nx, p = j * nx + i, own_j = own_row(j);
  bool left = i >= 1u, right = i + 1u < nx, up = own_j >= 1u, down = own_j + 1u < rows_of_cloth();
  Corner l = corner_at(left ? p - 1u : p), r = corner_at(right ? p + 1u : p);
  Corner a = corner_at(up ? p - nx : p), b = corner_at(down ? p + nx : p);
  Corner ar = corner_at(up && right ? p - nx + 1u : p), bl = corner_at(down && left ? p + nx - 1u : p);
  Push3 sum = Push3(real3(0.0), real(0.0));
  if (right && down && whole_a(p)) add_triangle(own, b, r, w, drag, lift, sum);
  if (left && down) {
    if (whole_b(p - 1u)) add_triangle(own, bl, b, w, drag, lift, sum);
    if (whole_a(p - 1u)) add_triangle(l, bl, own, w, drag, lift, sum);
  }
  if (right && up) {
    if (whole_b(p - nx)) add_triangle(ar, own, r, w, drag, lift, sum);
    if (whole_a(p - nx)) add_triangle(a, own, ar, w, drag, lift, sum);
  }
  if (left && up && whole_b(p - nx - 1u)) add_triangle(a, l, own, w, drag, lift, sum);
  return sum;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i, row = row_index * params.row_stride;
  real4 x = position[p];
  real3 v0 = velocity[p].xyz;
  precise real3 v = v0;
  if (x.w != 0.0) {
    real4 air = substeps[row + air_rows], lattice = substeps[row + air_rows + 1u];
    real4 force = substeps[row + air_rows + 2u];
    precise real3 w = air.xyz;
    if (noise) {
      precise real3 here = force.y * wind_noise(x.xyz, lattice.xyz, lattice.w, uint(force.x), air.w, seed);
      w = w + here;
    }
    Push3 sum = air_force(i, j, Corner(x.xyz, v0), w, force.z, force.w);
    precise real mass = x.w * params.inverse_mass_1_kg;
    real gain = substeps[row + 1u].x;
    precise real3 acc = sum.force * mass;
    precise real rate = sum.rate * mass;
    precise real3 change = gain * acc;
    precise real bound = gain * rate;
    bound = 1.0 + bound;
    change = change / bound;
    v = v0 + change;
  }
  position_next[p] = x;
  velocity_next[p] = real4(v, 0.0);
}
