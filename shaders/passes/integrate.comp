#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// One substep in one pass over memory: the springs' force by gather, kick, drift, contact.
// Each invocation writes its own particle of the *_next buffers and reads only the others: no races.
// Source: docs/physics.md "Time"; every operation's order is docs/float-form.md.

READS (vec4, substeps)
READS (vec4, position)
READS (vec4, velocity)
WRITES(vec4, position_next)
WRITES(vec4, velocity_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/effects.glsl"
#include "../shared/force.glsl"
#include "../shared/contact.glsl"

vec3 kicked(vec3 v0, vec3 F, float inverse_mass, uint row) {
  precise vec3 acc = F * inverse_mass;
  if (gravity) acc = acc + params.gravity_m_s2;
  if (wind) acc = acc + substeps[row].xyz;
  precise vec3 gain = substeps[row + 1u].x * acc;
  precise vec3 v = v0;
  if (air) v = substeps[row].w * v;
  v = v + gain;
  return v;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y;
  if (i >= params.nx || j >= params.ny) return;
  uint p = j * params.nx + i;
  uint row = row_index * params.row_stride;

  vec4 x0 = position[p];
  vec4 v0 = velocity[p];
  precise float w = x0.w * params.inverse_mass_1_kg;
  precise vec3 x1 = x0.xyz;
  precise vec3 v = v0.xyz;
  if (!pins || w != 0.0) {
    v = kicked(v0.xyz, spring_force(i, j, p, End(x0.xyz, v0.xyz)), w, row);
    float h = substeps[row + 1u].y;
    precise vec3 drift = h * v;
    x1 = x0.xyz + drift;
    if ((spheres || floor_contact) && h > 0.0) contact(row, x0.xyz, x1, v);
  }
  position_next[p] = vec4(x1, x0.w);
  velocity_next[p] = vec4(v, 0.0);
}
