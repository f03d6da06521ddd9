#version 460
#extension GL_GOOGLE_include_directive : require
// One triangle over the whole picture, infinitely far (depth 0).
#include "view.glsl"

layout(location = 0) out vec3 ray;

void main() {
  vec2 corner = vec2(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0);
  ray = view.ray_forward + corner.x * view.ray_right - corner.y * view.ray_up;
  gl_Position = vec4(corner, 0.0, 1.0);
}
