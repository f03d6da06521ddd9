#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// The step with the mean of the slopes at both ends. The *_next buffers hold where the step began.
// Each invocation reads and writes its own particles of the *_next buffers, and reads only the others:
// no races.
// Source: docs/solvers.md "Runge-Kutta stages".

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
UPDATES(real4, position_next)
UPDATES(real4, velocity_next)

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
  real relative = position[m.p].w;
  real3 x0 = position_next[m.p].xyz, v0 = velocity_next[m.p].xyz;
  Slope k = slope_at(s, c, m);
  precise real3 x1 = x0;
  precise real3 v1 = v0;
  if (!is_pinned(relative)) {
    precise real3 sum = v0 + k.x;
    precise real3 mean = 0.5 * sum;
    precise real3 kick = s.gain * k.v;
    precise real3 travelled = s.gain * sum;
    x1 = x0 + travelled;
    v1 = mean + kick;
    if (spheres || floor_contact) contact(s.row, x0, x1, v1);
  }
  position_next[m.p] = real4(x1, relative);
  velocity_next[m.p] = real4(v1, 0.0);
}

#include "../shared/march.glsl"
