#version 460
#extension GL_GOOGLE_include_directive : require
// A sphere of smooth glazed clay, or a small steel pin head.
#include "light.glsl"
#include "shadow.glsl"

layout(location = 0) in vec3 world_m;
layout(location = 1) in vec3 direction;
layout(location = 2) flat in uint is_pin;
layout(location = 0) out vec4 color;

void main() {
  vec3 n = normalize(direction), to_eye = normalize(view.eye_m - world_m);
  bool pin = is_pin == 1u;
  vec3 base = pin ? vec3(0.34, 0.35, 0.37) : vec3(0.10, 0.26, 0.34);
  float lit = shadow(world_m, n, 0.0);
  float towards = max(dot(n, view.to_light), 0.0);
  vec3 h = normalize(view.to_light + to_eye);
  float fresnel = 0.04 + 0.5 * pow(1.0 - max(dot(n, to_eye), 0.0), 5.0);
  vec3 light = base * (kKey * lit * towards * 0.52 + mix(kFloorFill, kSkyFill, 0.5 + 0.5 * n.y));
  light += kKey * lit * (pin ? 0.9 : 0.22) * pow(max(dot(n, h), 0.0), pin ? 40.0 : 60.0);
  light += fresnel * sky(reflect(-to_eye, n));
  color = to_screen(light);
}
