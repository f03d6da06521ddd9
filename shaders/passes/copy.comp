#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Copies a buffer, one vec4 an invocation: the memory bandwidth that `bench` holds every pass against.
// Not part of any plan.

READS (vec4, position)
WRITES(vec4, position_next)

layout(local_size_x = 64) in;

void main() {
  uint p = gl_GlobalInvocationID.y * (gl_NumWorkGroups.x * gl_WorkGroupSize.x) + gl_GlobalInvocationID.x;
  if (p < position.length()) position_next[p] = position[p];
}
