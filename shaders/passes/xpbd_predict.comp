#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Where each particle would go by itself: gravity and the exact kick of air, no springs.
// Each invocation writes its own particle of position_next: no races.
// Source: Macklin et al. 2019, Small Steps in Physics Simulation, algorithm 1; docs/solvers.md "xpbd".

READS (vec4, substeps)
READS (vec4, position)
READS (vec4, velocity)
WRITES(vec4, position_next)

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
  vec4 own = position[p];
  precise vec3 x1 = own.xyz;
  if (own.w != 0.0) {
    precise vec3 travelled = s.drift * kicked(s, velocity[p].xyz, acceleration(s, vec3(0.0), 0.0));
    x1 = own.xyz + travelled;
  }
  position_next[p] = vec4(x1, own.w);
}
