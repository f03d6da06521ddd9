#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// `aerodynamics` for a cloth whose links break: the air acts on the triangles that are whole.
// Each invocation writes its own particle of the *_next buffers and reads only the others: no races.
// Source: as aerodynamics.comp.

#define TORN
#include "../shared/aerodynamics.glsl"
