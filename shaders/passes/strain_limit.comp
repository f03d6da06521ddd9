#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Pulls the springs of one colour that are longer than their limit back to it, by inverse mass, and takes
// from the ends' velocities what the move means, but never more than what drives them apart.
// Springs of a colour share no particle, so plain writes neither race nor depend on order.
// Source: Provot 1995, Deformation constraints in a mass-spring model to describe rigid cloth behavior,
// sect. 4; velocities as in Mueller et al. 2007, Position based dynamics, sect. 3.1; docs/physics.md
// "Strain limit".

READS (real4, substeps)
READS (real4, strain_limits)
UPDATES(real4, position)
UPDATES(real4, velocity)

#ifdef WEFT_REACH
#include "../shared/reach.h"
UPDATES(uint, reach_groups)
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index, item; };

#include "../shared/dot.glsl"
#include "../shared/spring_colours.glsl"

void main() {
#ifdef WEFT_REACH
  // After the last colour of its shape: they are asked for in this substep alone.
  if (gl_GlobalInvocationID.xy == uvec2(0u)) {
    if (item == 3u) reach_groups[kReachLinksDown] = 0u;
    if (item == 7u) reach_groups[kReachLinks] = 0u;
  }
#endif
  Spring s;
  if (!coloured_spring(item, s)) return;
  real4 limit = strain_limits[s.kind <= kStructuralJ ? kLimitStructural : kLimitShear];
  real4 a = position[s.a], b = position[s.b];
  precise real3 d = b.xyz - a.xyz;
  precise real q = dot3(d, d);
  precise real w = a.w + b.w;
  if (!(q > limit.y) || w == 0.0) return;
  precise real l = sqrt(q);
  precise real inverse = 1.0 / l;
  precise real3 n = d * inverse;
  precise real excess = l - limit.x;
  precise real share = excess / w;
  precise real3 push = share * n;
  precise real3 xa = a.xyz + a.w * push;
  precise real3 xb = b.xyz - b.w * push;
  real3 va = velocity[s.a].xyz, vb = velocity[s.b].xyz;
  precise real3 dv = vb - va;
  precise real apart = max(dot3(n, dv), 0.0);
  precise real cut = excess / substeps[row_index * params.row_stride + 1u].y;
  cut = min(cut, apart);
  cut = cut / w;
  precise real3 kick = cut * n;
  precise real3 va1 = va + a.w * kick;
  precise real3 vb1 = vb - b.w * kick;
  position[s.a] = real4(xa, a.w);
  position[s.b] = real4(xb, b.w);
  velocity[s.a] = real4(va1, 0.0);
  velocity[s.b] = real4(vb1, 0.0);
}
