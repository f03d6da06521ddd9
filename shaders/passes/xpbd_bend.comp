#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Straightens the bending triples of one colour: one Gauss-Seidel sweep, compliance = 1/kappa.
// Triples of a colour share no particle, so plain writes neither race nor depend on order.
// Source: Macklin et al. 2016, XPBD, eq. 18, lambda starting at zero; docs/solvers.md "xpbd".

READS (real4, substeps)
READS (real4, constraints)
READS (real4, position)         // where the substep began
UPDATES(real4, position_next)  // how far each has moved since

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index, item; };

layout(constant_id = 0) const bool anisotropic = false;
#include "../shared/sheets.glsl"

void main() {
  bool along_i = item < 3u;
  uint colour = item % 3u, nx = params.nx, ny = rows_of_cloth(), first = 0u;
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (sheet_rows != 0u) {  // as many lanes as one cloth alone would have, then the next one's
    uint lanes = along_i ? ny : (ny - colour) / 3u;
    first = j / lanes * ny;
    j = j % lanes;
  }
  if (along_i)
    i = 3u * i + colour;
  else
    j = 3u * j + colour;
  uint next = along_i ? 1u : nx;
  if (i >= nx || j >= ny || (along_i ? i + 2u >= nx : j + 2u >= ny)) return;
  bool boundary = along_i ? (j == 0u || j + 1u == ny) : (i == 0u || i + 1u == nx);
  uint warp = anisotropic && !along_i ? kConstraintRows : 0u;
  real compliance = constraints[kConstraintBend + (boundary ? 1u : 0u) + warp].y;

  uint pa = (first + j) * nx + i, pb = pa + next, pc = pb + next;
  real4 a = position_next[pa], b = position_next[pb], c = position_next[pc];
  precise real wa = a.w * params.inverse_mass_1_kg;
  precise real wb = b.w * params.inverse_mass_1_kg;
  precise real wc = c.w * params.inverse_mass_1_kg;
  precise real w = (wa + 4.0 * wb) + wc;
  if (w == 0.0) return;
  precise real rate = 1.0 / substeps[row_index * params.row_stride + 1u].y;
  precise real stiff = compliance * (rate * rate);
  precise real3 start = (position[pa].xyz - 2.0 * position[pb].xyz) + position[pc].xyz;
  precise real3 moved = (a.xyz - 2.0 * b.xyz) + c.xyz;
  precise real3 push = start + moved;
  push = push / (w + stiff);
  precise real wb2 = 2.0 * wb;
  precise real3 xa = a.xyz - wa * push;
  precise real3 xb = b.xyz + wb2 * push;
  precise real3 xc = c.xyz - wc * push;
  position_next[pa] = real4(xa, a.w);
  position_next[pb] = real4(xb, b.w);
  position_next[pc] = real4(xc, c.w);
}
