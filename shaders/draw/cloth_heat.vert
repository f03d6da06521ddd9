#version 460
#extension GL_GOOGLE_include_directive : require
// The cloth with its local strain: the largest relative elongation, by size, of the structural edges that
// meet at a particle, read from the position buffer itself.
#include "view.glsl"

layout(scalar, set = 0, binding = 3) restrict readonly buffer Positions { vec4 positions[]; };

layout(location = 0) in vec4 position;
layout(location = 1) in vec4 normal;

layout(location = 0) out vec3 world_m;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec2 flat_m;
layout(location = 3) out float strain;
layout(location = 4) flat out uint cloth;  // which one

void consider(uint neighbour, bool exists) {
  float s = distance(positions[exists ? neighbour : gl_VertexIndex].xyz, position.xyz) / view.spacing_m - 1.0;
  if (exists && abs(s) > abs(strain)) strain = s;
}

void main() {
  world_m = position.xyz;
  world_normal = normal.xyz;
  uint own = uint(gl_VertexIndex), j = own / view.nx, i = own - j * view.nx;
  cloth = j / view.ny;
  flat_m = vec2(i, j - cloth * view.ny) * view.spacing_m;
  strain = 0.0;
  consider(own - 1u, i > 0u);
  consider(own + 1u, i + 1u < view.nx);
  consider(own - view.nx, j > cloth * view.ny);
  consider(own + view.nx, j + 1u < (cloth + 1u) * view.ny);
  gl_Position = cloth_in_clip(position.xyz, j);
}
