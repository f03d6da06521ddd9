#version 460
#extension GL_GOOGLE_include_directive : require
// The balls as the light sees them; depth only.
#include "view.glsl"
#include "ball.glsl"

void main() {
  vec4 ball = view.balls[gl_InstanceIndex];
  gl_Position = view.shadow_clip * vec4(ball.xyz + ball.w * ball_direction(uint(gl_VertexIndex)), 1.0);
}
