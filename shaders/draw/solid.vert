#version 460
#extension GL_GOOGLE_include_directive : require
// Capsules, boxes and meshes: vertices in the body's own frame, which the host pushes.
#include "view.glsl"

layout(location = 0) in vec4 position;
layout(location = 1) in vec4 normal;
layout(push_constant) uniform Push { mat4 own_to_world; };

layout(location = 0) out vec3 world_m;
layout(location = 1) out vec3 direction;
layout(location = 2) flat out uint is_pin;

void main() {
  world_m = (own_to_world * vec4(position.xyz, 1.0)).xyz;
  direction = mat3(own_to_world) * normal.xyz;
  is_pin = 0u;
  gl_Position = view.clip * vec4(world_m, 1.0);
}
