#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Contact with capsules, boxes and then the floor, which always holds, after a drift that began where
// position_next still says.
// Each invocation reads and writes its own particle only: no races.
// Source: docs/physics.md "Contact"; every operation's order is docs/float-form.md.

READS (real4, substeps)
READS (real4, position_next)
UPDATES(real4, position)
UPDATES(real4, velocity)
#ifdef WEFT_REACH
#include "../shared/reach.h"
UPDATES(uint, reach_groups)
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };

layout(constant_id = 0) const uint solids = 1u;      // capsules and boxes
layout(constant_id = 1) const uint solid_rows = 2u;  // where they begin in the row
layout(constant_id = 2) const bool level_floor = true;
layout(constant_id = 3) const uint tilted_floor = 0u;  // where it stands in the row; 0: there is none
#include "../shared/dot.glsl"
#include "../shared/cross.glsl"
#include "../shared/respond.glsl"
#include "../shared/solid.glsl"
#include "../shared/ground.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i, row = row_index * params.row_stride;
#ifdef WEFT_REACH
  if (p == 0u) reach_groups[kReachSolids] = 0u;  // done: it asks for the next substep alone
#endif
  real4 own = position[p];
  if (own.w == 0.0) return;
  real3 x0 = position_next[p].xyz, x1 = own.xyz, v = velocity[p].xyz;
  for (uint s = 0u; s < solids; ++s) solid_touch(row + solid_rows + s * kRowSolidVec4s, x0, x1, v);
  if (level_floor) level_touch(x1, v);
  if (tilted_floor != 0u) tilted_touch(substeps[row + tilted_floor], x1, v);
  if (x1 == own.xyz && v == velocity[p].xyz) return;
  position[p] = real4(x1, own.w);
  velocity[p] = real4(v, 0.0);
}
