#version 460
#extension GL_GOOGLE_include_directive : require
// The floor: one square around the scene, large enough to fade into the horizon before it ends.
#include "view.glsl"

layout(location = 0) out vec3 world_m;

void main() {
  vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
  float reach = 40.0 * view.fade_m;
  vec2 at = view.focus_m.xz + corner * reach;
  float rise = dot(view.floor_normal.xz, at) / view.floor_normal.y;
  world_m = vec3(at.x, view.floor_m - rise, at.y);
  gl_Position = view.clip * vec4(world_m, 1.0);
}
