#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Rounds positions and normals to float, as drawing reads them; only in plans of double precision.
// Each invocation writes its own particle: no races.

READS (real4, position)
READS (real4, normal)
WRITES(vec4, draw_position)
WRITES(vec4, draw_normal)

layout(local_size_x = 64) in;

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i;
  draw_position[p] = vec4(position[p]);
  draw_normal[p] = vec4(normal[p]);
}
