#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// How far each particle would move by itself: gravity and the exact kick of air, no springs. Until
// xpbd_finish, position_next holds moves, which floats resolve more finely than places.
// Each invocation writes its own particle of position_next: no races.
// Source: Macklin et al. 2019, Small Steps in Physics Simulation, algorithm 1; docs/solvers.md "xpbd".

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };

layout(constant_id = 0) const bool air = true;
layout(constant_id = 1) const bool wind = true;
layout(constant_id = 2) const bool gravity = true;
#include "../shared/kick.glsl"

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i;
  Step s = step_of(row_index * params.row_stride);
  real4 own = position[p];
  precise real3 moved = real3(0.0);
  if (own.w != 0.0) moved = s.drift * kicked(s, velocity[p].xyz, acceleration(s, real3(0.0), 0.0));
  position_next[p] = real4(moved, own.w);
}
