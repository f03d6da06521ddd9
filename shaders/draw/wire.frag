#version 460
#extension GL_GOOGLE_include_directive : require
// The cloth's springs as lines, lit so that depth can be read.
#include "light.glsl"

layout(constant_id = 2) const bool kHeat = false;

layout(location = 0) in vec3 world_m;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec2 flat_m;
layout(location = 3) in float strain;
layout(location = 0) out vec4 color;

void main() {
  vec3 to_eye = normalize(view.eye_m - world_m);
  bool front = dot(world_normal, to_eye) > 0.0;
  vec3 base = front ? vec3(0.46, 0.05, 0.04) : vec3(0.30, 0.19, 0.08);
  float t = clamp(strain / view.heat_full, -1.0, 1.0);
  if (kHeat) base = mix(vec3(0.20), t > 0.0 ? vec3(0.75, 0.06, 0.0) : vec3(0.02, 0.08, 0.6), abs(t));
  float towards = abs(dot(world_normal, view.to_light));
  color = to_screen(base * (kSkyFill + kKey * 0.4 * towards));
}
