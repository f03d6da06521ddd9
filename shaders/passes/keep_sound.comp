#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Last of the three: keeps the state while it is sound, so that the last good one is there when a later one
// is not. Each invocation copies its own particle.

#include "../shared/watch.h"
READS (real4, position)
READS (real4, velocity)
READS (uint, watch_state)
WRITES(real4, kept_position)
WRITES(real4, kept_velocity)

layout(local_size_x = 64) in;

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, nx = params.nx;
  if (i >= nx || j >= params.ny || watch_state[kWatchStopped] != 0u) return;
  kept_position[j * nx + i] = position[j * nx + i];
  kept_velocity[j * nx + i] = velocity[j * nx + i];
}
