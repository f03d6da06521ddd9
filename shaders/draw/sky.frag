#version 460
#extension GL_GOOGLE_include_directive : require
// The sky's gradient.
#include "light.glsl"

layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 color;

void main() { color = to_screen(sky(normalize(ray))); }
