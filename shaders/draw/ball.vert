#version 460
#extension GL_GOOGLE_include_directive : require
// Colliding spheres and pin heads, one instance each.
#include "view.glsl"
#include "ball.glsl"

layout(location = 0) out vec3 world_m;
layout(location = 1) out vec3 direction;
layout(location = 2) flat out uint is_pin;

void main() {
  vec4 ball = view.balls[gl_InstanceIndex];
  direction = ball_direction(uint(gl_VertexIndex));
  world_m = ball.xyz + ball.w * direction;
  is_pin = uint(gl_InstanceIndex) >= view.sphere_count ? 1u : 0u;
  gl_Position = view.clip * vec4(world_m, 1.0);
}
