#version 460
#extension GL_GOOGLE_include_directive : require
#define WEFT_REACH
#include "../shared/pass.glsl"
#include "../shared/links.h"

// integrate_torn with compensated summation of positions and velocities (f32k): docs/solvers.md.
// Source: Kahan 1965.

#define COMPENSATED
#include "../shared/integrate_torn.glsl"
