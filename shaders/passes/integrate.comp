#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// One substep in one pass over memory: the springs' force by gather, kick, drift, contact.
// Each invocation writes its own particles of the *_next buffers and reads only the others: no races.
// Source: docs/physics.md "Time"; every operation's order is docs/float-form.md.
#include "../shared/integrate.glsl"
