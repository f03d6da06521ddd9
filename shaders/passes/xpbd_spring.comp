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
layout(constant_id = 1) const bool anisotropic = false;
#include "../shared/dot.glsl"

#include "../shared/spring_colours.glsl"

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
  Spring s;
  if (!coloured_spring(item, s)) return;
  uint row = kConstraintShear;
  bool along_i = s.kind == kStructuralI || s.kind == kFlexI;
  bool along_j = s.kind == kStructuralJ || s.kind == kFlexJ;
  if (along_i || along_j) {
    bool on_row = s.j == 0u || s.j + 1u == rows_of_cloth(), on_column = s.i == 0u || s.i + 1u == params.nx;
    bool boundary = along_i ? on_row : on_column;
    bool far = s.kind == kFlexI || s.kind == kFlexJ;
    row = (far ? kConstraintFlex : kConstraintStructural) + (boundary ? 1u : 0u);
    if (anisotropic && along_j) row += kConstraintRows;
  }
  pull(s.a, s.b, constraints[row].xyz);
}
