#version 460
#extension GL_GOOGLE_include_directive : require
// The cloth, straight from the compute passes' position and normal buffers.
#include "view.glsl"

layout(location = 0) in vec4 position;
layout(location = 1) in vec4 normal;

layout(location = 0) out vec3 world_m;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec2 flat_m;  // place on the flat cloth
layout(location = 3) out float strain;
layout(location = 4) flat out uint cloth;  // which one

void main() {
  world_m = position.xyz;
  world_normal = normal.xyz;
  uint j = uint(gl_VertexIndex) / view.nx, i = uint(gl_VertexIndex) - j * view.nx;
  cloth = j / view.ny;
  flat_m = vec2(i, j - cloth * view.ny) * view.spacing_m;
  strain = 0.0;
  gl_Position = cloth_in_clip(position.xyz, j);
}
