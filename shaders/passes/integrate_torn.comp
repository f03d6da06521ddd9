#version 460
#extension GL_GOOGLE_include_directive : require
#define WEFT_REACH
#include "../shared/pass.glsl"
#include "../shared/links.h"

// `integrate` for a cloth of which links are broken: every particle gathers the springs of its whole links,
// in the order of docs/float-form.md "Tearing". With nothing broken its bits would be those of
// integrate.comp, which moves the cloth until then.
// Each invocation reads one half of the ping-pong and writes its own particle to the other: no races.

#include "../shared/integrate_torn.glsl"
