#version 460
#extension GL_GOOGLE_include_directive : require
// The cloth as the light sees it; depth only.
#include "view.glsl"

layout(location = 0) in vec4 position;

void main() { gl_Position = view.shadow_clip * vec4(position.xyz, 1.0); }
