#version 460
#extension GL_GOOGLE_include_directive : require
#define COMPENSATED
#include "../shared/pass.glsl"

// integrate with compensated summation of the positions (f32k).
// Each invocation writes its own particles and reads of the others only what nobody writes: no races.
// Source: Kahan, Further remarks on reducing truncation errors, CACM 8 (1965) 40; docs/solvers.md "f32k".

#include "../shared/integrate.glsl"
