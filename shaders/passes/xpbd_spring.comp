#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Pulls the springs of one colour towards their rest length: one Gauss-Seidel sweep, compliance = 1/k.
// Springs of a colour share no particle, so plain writes neither race nor depend on order.
// Source: Macklin et al. 2016, XPBD, eq. 18 and 26, lambda starting at zero; docs/solvers.md "xpbd".

READS (real4, substeps)
READS (real4, constraints)
READS (real4, position)         // where the substep began
UPDATES(real4, position_next)  // how far each has moved since

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index, item; };

layout(constant_id = 0) const bool damping = true;
#include "../shared/dot.glsl"

const uint kStructuralI = 0u, kStructuralJ = 1u, kShearUp = 3u, kFlexI = 4u, kFlexJ = 5u;

// The n-th place of a colour where two of every four belong to it: 0 1 4 5 ..., 2 3 6 7 ...
uint pair_of_two(uint n, uint colour) { return (n / 2u) * 4u + colour * 2u + n % 2u; }

void pull(uint pa, uint pb, real3 k) {
  real4 a = position_next[pa], b = position_next[pb];
  precise real wa = a.w * params.inverse_mass_1_kg;
  precise real wb = b.w * params.inverse_mass_1_kg;
  precise real w = wa + wb;
  if (w == 0.0) return;
  precise real rate = 1.0 / substeps[row_index * params.row_stride + 1u].y;
  precise real stiff = k.y * (rate * rate);
  precise real3 moved = b.xyz - a.xyz;
  precise real3 start = position[pb].xyz - position[pa].xyz;
  precise real3 d = start + moved;
  precise real l = sqrt(max(dot3(d, d), kTinyLengthSquared));
  precise real inverse = 1.0 / l;
  precise real3 n = d * inverse;
  precise real error = l - k.x;
  precise real weight = w;
  if (damping) {
    precise real gamma = k.z * rate;
    precise real along = gamma * dot3(n, moved);
    error = error + along;
    weight = (1.0 + gamma) * w;
  }
  precise real size = error / (weight + stiff);
  precise real3 push = size * n;
  precise real3 next_a = a.xyz + wa * push;
  precise real3 next_b = b.xyz - wb * push;
  position_next[pa] = real4(next_a, a.w);
  position_next[pb] = real4(next_b, b.w);
}

void main() {
  uint kind = item / 2u, colour = item % 2u, nx = params.nx, ny = params.ny;
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  uvec2 reach = uvec2(1u, 1u);
  if (kind == kStructuralI) reach = uvec2(1u, 0u);
  if (kind == kStructuralJ) reach = uvec2(0u, 1u);
  if (kind == kFlexI) reach = uvec2(2u, 0u);
  if (kind == kFlexJ) reach = uvec2(0u, 2u);
  if (kind == kStructuralJ)
    j = 2u * j + colour;
  else if (kind == kFlexI)
    i = pair_of_two(i, colour);
  else if (kind == kFlexJ)
    j = pair_of_two(j, colour);
  else
    i = 2u * i + colour;
  if (i + reach.x >= nx || j + reach.y >= ny) return;

  uint row = kConstraintShear;
  bool along_i = reach.y == 0u, along_j = reach.x == 0u;
  if (along_i || along_j) {
    bool boundary = along_i ? (j == 0u || j + 1u == ny) : (i == 0u || i + 1u == nx);
    row = (kind == kFlexI || kind == kFlexJ ? kConstraintFlex : kConstraintStructural) + (boundary ? 1u : 0u);
  }
  uint own = j * nx + i;
  bool rising = kind == kShearUp;
  pull(rising ? own + 1u : own, rising ? own + nx : own + reach.y * nx + reach.x, constraints[row].xyz);
}
