#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// One step of explicit Euler: the position drifts with the old velocity.
// Each invocation writes its own particles of the *_next buffers and reads only the others: no races.
// Source: docs/solvers.md "euler".

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

void move(Step s, Column c, inout March m) {
  real relative = position[m.p].w;
  real3 x0 = m.own.x, v0 = damping ? m.own.v : velocity[m.p].xyz;
  precise real3 F = spring_force(c, m);
  precise real w = relative * s.inverse_mass;
  precise real3 x1 = x0;
  precise real3 v = v0;
  if (!pins || w != 0.0) {
    precise real3 travelled = s.drift * v0;
    x1 = x0 + travelled;
    v = kicked(s, v0, acceleration(s, F, w));
    if (spheres || floor_contact) contact(s.row, x0, x1, v);
  }
  position_next[m.p] = real4(x1, relative);
  velocity_next[m.p] = real4(v, 0.0);
}

#include "../shared/march.glsl"
