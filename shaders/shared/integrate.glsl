// The body of integrate.comp and of its compensated form (f32k), which define COMPENSATED or not.

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)
#ifdef COMPENSATED
UPDATES(real4, compensation)
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "effects.glsl"
#include "held_params.glsl"
layout(constant_id = 10) const uint rows = 1u;  // that an invocation marches down; the device's choice
#include "reach.glsl"
#include "force.glsl"
#include "contact.glsl"
#include "spread.glsl"
#include "kick.glsl"
#include "drift.glsl"

void move(Step s, Column c, inout March m) {
  real relative = position[m.p].w;
  real3 x0 = m.own.x, v0 = damping ? m.own.v : velocity[m.p].xyz;
  precise real3 F = spring_force(c, m);
  precise real w = relative * s.inverse_mass;
  precise real3 x1 = x0;
  precise real3 v = v0;
  if (!pins || w != 0.0) {
    v = kicked_at(m.p, s, v0, acceleration(s, F, w));
    x1 = drifted_at(m.p, s, x0, v);
    if ((spheres || floor_contact) && s.drift > 0.0) touched_at(m.p, s, x0, x1, v);
    look_for_bodies(x0, x1);
    look_at_kick(s.drift, x0, v0, x1, v);
  }
  position_next[m.p] = real4(x1, relative);
  velocity_next[m.p] = real4(v, 0.0);
}

#include "march.glsl"
