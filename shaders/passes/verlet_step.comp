#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Position Verlet as cloth demos teach it: x1 = 2·x0 - previous + acc·h².
// Each invocation writes its own particles and reads of the others only what nobody writes: no races.
// Source: docs/solvers.md "verlet".

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)
UPDATES(real4, position_previous)

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
  precise real3 behind = x0;
  if (!pins || w != 0.0) {
    precise real3 travelled = s.drift * v0;
    if (row_index != 0u) travelled = x0 - position_previous[m.p].xyz;
    if (air) {
      precise real3 lost = s.loss * travelled;
      travelled = travelled - lost;
    }
    precise real gain = s.gain * s.drift;
    precise real3 pushed = gain * acceleration(s, F, w);
    x1 = x0 + travelled;
    x1 = x1 + pushed;
    v = x1 - x0;
    v = v / s.drift;
    if (spheres || floor_contact) {
      real3 free_x = x1, free_v = v;
      contact(s.row, x0, x1, v);
      if (x1 != free_x || v != free_v) {  // as if it had always moved so
        precise real3 back = s.drift * v;
        behind = x1 - back;
      }
    }
  }
  position_next[m.p] = real4(x1, relative);
  velocity_next[m.p] = real4(v, 0.0);
  position_previous[m.p] = real4(behind, 0.0);
}

#include "../shared/march.glsl"
