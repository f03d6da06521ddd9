#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"
#include "../shared/links.h"

// `integrate` for a cloth whose links break: every particle gathers the springs of its whole links, in the
// order of docs/float-form.md "Tearing". With nothing broken its bits are those of integrate.comp.
// Each invocation reads one half of the ping-pong and writes its own particle to the other: no races.

#include "../shared/integrate_torn.glsl"
