// The body of velocity_verlet_step.comp and of its compensated form (f32k), which define COMPENSATED or not.

READS (real4, substeps)
READS (real4, position)
READS (real4, velocity)
WRITES(real4, position_next)
WRITES(real4, velocity_next)
UPDATES(real4, half_velocity)
#ifdef COMPENSATED
UPDATES(real4, compensation)
#endif

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "effects.glsl"
#include "held_params.glsl"
layout(constant_id = 10) const uint rows = 1u;  // that an invocation marches down; the device's choice
#include "force.glsl"
#include "contact.glsl"
#include "kick.glsl"
#include "drift.glsl"

void move(Step s, Column c, inout March m) {
  real relative = position[m.p].w;
  real3 x0 = m.own.x, v0 = damping ? m.own.v : velocity[m.p].xyz;
  precise real3 F = spring_force(c, m);
  precise real w = relative * s.inverse_mass;
  precise real3 x1 = x0;
  precise real3 v = v0;
  precise real3 predicted = v0;
  if (!pins || w != 0.0) {
    precise real3 acc = acceleration(s, F, w);
    v = kicked_at(m.p, s, row_index == 0u ? v0 : half_velocity[m.p].xyz, acc);
    x1 = drifted_at(m.p, s, x0, v);
    if ((spheres || floor_contact) && s.drift > 0.0) touched_at(m.p, s, x0, x1, v);
    predicted = v + kick_change(s.predict_loss, s.predict_gain, v, acc);
  }
  position_next[m.p] = real4(x1, relative);
  velocity_next[m.p] = real4(predicted, 0.0);
  half_velocity[m.p] = real4(v, 0.0);
}

#include "march.glsl"
