#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Brings every particle that is farther from its nearest pin than the flat cloth between them is long back to
// that distance. Each invocation writes its own particle; its anchor is pinned, and no invocation writes
// pinned ones: no races.
// Source: Kim, Chentanez and Mueller 2012, Long Range Attachments, section 3; docs/solvers.md "xpbd".

READS (Tether, tethers)
READS (real4, position)         // where the substep began
UPDATES(real4, position_next)  // how far each has moved since

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };

#include "../shared/dot.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i, a = tethers[p].anchor;
  real reach = tethers[p].reach_m;
  if (position[p].w == 0.0 || reach < 0.0) return;
  real4 own = position_next[p];
  precise real3 began = position[p].xyz - position[a].xyz;
  precise real3 moved = own.xyz - position_next[a].xyz;
  precise real3 d = began + moved;
  precise real q = dot3(d, d);
  precise real limit = reach * reach;
  if (!(q > limit)) return;
  precise real l = sqrt(q);
  precise real excess = l - reach;
  precise real inverse = 1.0 / l;
  precise real share = excess * inverse;
  precise real3 push = share * d;
  precise real3 next = own.xyz - push;
  position_next[p] = real4(next, own.w);
}
