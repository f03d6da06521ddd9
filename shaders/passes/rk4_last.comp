#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// The last stage, the whole step from its start, and contact over it.
// Each invocation writes its own particles and reads of the others only what nobody writes: no races.
// Source: docs/solvers.md "Runge-Kutta stages".

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)
READS (real4, base_position)
READS (real4, base_velocity)
READS (real4, sum_position)
READS (real4, sum_velocity)

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
  real3 x0 = base_position[m.p].xyz, v0 = base_velocity[m.p].xyz;
  Slope k = slope_at(s, c, m);
  precise real3 x1 = x0;
  precise real3 v1 = v0;
  if (!is_pinned(relative)) {
    precise real3 step_x = sum_position[m.p].xyz + s.gain * k.x;
    precise real3 step_v = sum_velocity[m.p].xyz + s.gain * k.v;
    x1 = x0 + step_x;
    v1 = v0 + step_v;
    if (spheres || floor_contact) contact(s.row, x0, x1, v1);
  }
  position_next[m.p] = real4(x1, relative);
  velocity_next[m.p] = real4(v1, 0.0);
}

#include "../shared/march.glsl"
