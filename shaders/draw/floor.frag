#version 460
#extension GL_GOOGLE_include_directive : require
// Chequered floor with soft shadows, fading into the sky's horizon.
#include "light.glsl"
#include "shadow.glsl"

layout(location = 0) in vec3 world_m;
layout(location = 0) out vec4 color;

void main() {
  vec3 n = view.floor_normal, to_eye = normalize(view.eye_m - world_m);
  vec2 square = world_m.xz / view.checker_m;
  float check = filtered_checker(square, fwidth(square));
  vec3 base = mix(vec3(0.20, 0.21, 0.23), vec3(0.47, 0.465, 0.45), check);
  float lit = shadow(world_m, n, 0.0);
  float open = ball_occlusion(world_m, n);
  vec3 light = base * (kKey * lit * max(dot(n, view.to_light), 0.0) * 0.42 + kSkyFill * open);
  float sheen = 0.03 + 0.30 * pow(1.0 - max(dot(n, to_eye), 0.0), 5.0);
  light += sheen * sky(reflect(-to_eye, n)) * (0.4 + 0.6 * lit);
  float away = length(world_m.xz - view.focus_m.xz) / view.fade_m;
  light *= 0.72 + 0.28 * exp(-14.0 * away * away);  // a pool of light where the scene is
  color = to_screen(mix(kHorizon, light, exp(-away * away)));
}
