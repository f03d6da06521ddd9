#version 460
#extension GL_GOOGLE_include_directive : require
// Capsules, boxes and meshes as the light sees them; depth only.
#include "view.glsl"

layout(location = 0) in vec4 position;
layout(push_constant) uniform Push { mat4 own_to_world; };

void main() { gl_Position = view.shadow_clip * own_to_world * vec4(position.xyz, 1.0); }
