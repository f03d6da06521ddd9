#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Drag and lift of the triangles around each particle, two-sided and quadratic in the speed, as a kick that
// cannot overshoot. Each invocation writes its own particle of the *_next buffers and reads only the others:
// no races.
// Source: forces by triangle as in Wejchert and Haumann 1991, Animation aerodynamics; docs/physics.md
// "Aerodynamics"; every operation's order is docs/float-form.md.

#include "../shared/aerodynamics.glsl"
