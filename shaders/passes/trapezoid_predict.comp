#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// An Euler step to the far end of the trapezoid, where the second slope is taken.
// Each invocation writes its own particles of the *_next buffers and reads only the others: no races.
// Source: docs/solvers.md "Runge-Kutta stages".

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/effects.glsl"
#include "../shared/held_params.glsl"
layout(constant_id = 10) const uint rows = 1u;  // that an invocation marches down; the device's choice
#include "../shared/force.glsl"
#include "../shared/contact.glsl"
#include "../shared/kick.glsl"
#include "../shared/stage.glsl"

void move(Step s, Column c, inout March m) {
  real3 x0 = m.own.x, v0 = damping ? m.own.v : velocity[m.p].xyz;
  Slope k = slope_at(s, c, m);
  precise real3 x1 = x0 + s.drift * k.x;
  precise real3 v1 = v0 + s.gain * k.v;
  position_next[m.p] = real4(x1, position[m.p].w);
  velocity_next[m.p] = real4(v1, 0.0);
}

#include "../shared/march.glsl"
