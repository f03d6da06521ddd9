#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// One substep in one pass over memory: the springs' force by gather, kick, drift, contact.
// Each invocation writes its own particles of the *_next buffers and reads only the others: no races.
// Source: docs/physics.md "Time"; every operation's order is docs/float-form.md.

READS (vec4, substeps)
READS (vec4, position)
READS (vec4, velocity)
WRITES(vec4, position_next)
WRITES(vec4, velocity_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/effects.glsl"
layout(constant_id = 10) const uint rows = 1u;  // that an invocation marches down; the device's choice
#include "../shared/force.glsl"
#include "../shared/contact.glsl"

// The dispatch's row of the table and what else is the same for all particles, read once.
struct Step {
  uint row;
  float inverse_mass, decay, gain, drift;
  vec3 alpha_wind, gravity_m_s2;
};

Step step_of(uint row) {
  vec4 air_row = substeps[row], times = substeps[row + 1u];
  return Step(row, params.inverse_mass_1_kg, air_row.w, times.x, times.y, air_row.xyz, params.gravity_m_s2);
}

vec3 kicked(Step s, vec3 v0, vec3 F, float w) {
  precise vec3 acc = F * w;
  if (gravity) acc = acc + s.gravity_m_s2;
  if (wind) acc = acc + s.alpha_wind;
  precise vec3 gain = s.gain * acc;
  precise vec3 v = v0;
  if (air) v = s.decay * v;
  v = v + gain;
  return v;
}

void move(Step s, Column c, inout March m) {
  float relative = position[m.p].w;
  vec3 x0 = m.own.x, v0 = damping ? m.own.v : velocity[m.p].xyz;
  precise vec3 F = spring_force(c, m);
  precise float w = relative * s.inverse_mass;
  precise vec3 x1 = x0;
  precise vec3 v = v0;
  if (!pins || w != 0.0) {
    v = kicked(s, v0, F, w);
    precise vec3 travelled = s.drift * v;
    x1 = x0 + travelled;
    if ((spheres || floor_contact) && s.drift > 0.0) contact(s.row, x0, x1, v);
  }
  position_next[m.p] = vec4(x1, relative);
  velocity_next[m.p] = vec4(v, 0.0);
}

void main() {
  uint i = gl_GlobalInvocationID.x, first = gl_GlobalInvocationID.y * rows;
  if (i >= params.nx || first >= params.ny) return;
  Step s = step_of(row_index * params.row_stride);
  Column c = column_at(i);
  March m = march_from(c, first);
  uint last = min(first + rows, c.ny) - 1u;
  while (true) {
    move(s, c, m);
    if (m.j >= last) break;
    step_down(c, m);
  }
}
