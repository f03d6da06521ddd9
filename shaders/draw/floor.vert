#version 460
#extension GL_GOOGLE_include_directive : require
// The floor: one square around the scene, large enough to fade into the horizon before it ends.
#include "view.glsl"

layout(location = 0) out vec3 world_m;

void main() {
  vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
  float reach = 40.0 * view.fade_m;
  world_m = vec3(view.focus_m.x + corner.x * reach, view.floor_m, view.focus_m.z + corner.y * reach);
  gl_Position = view.clip * vec4(world_m, 1.0);
}
