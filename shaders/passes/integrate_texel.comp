#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// `integrate` with positions and velocities read as texels. Each invocation writes its own particles of
// the *_next buffers and reads only the others: no races. The bits are those of integrate.comp.
// Source: docs/float-form.md; measured in docs/performance.md.

READS (vec4, substeps)
READS_TEXELS(position)
READS_TEXELS(velocity)
WRITES(vec4, position_next)
WRITES(vec4, velocity_next)

layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/effects.glsl"
#include "../shared/held_params.glsl"
layout(constant_id = 10) const uint rows = 1u;  // that an invocation marches down; the device's choice

#define SOURCE_POSITION(p) position_texel(p)
#define SOURCE_VELOCITY(p) velocity_texel(p)

#include "../shared/reach.glsl"
#include "../shared/force.glsl"
#include "../shared/contact.glsl"
#include "../shared/spread.glsl"
#include "../shared/kick.glsl"
#include "../shared/step_particle.glsl"

void move(Step s, Column c, inout March m) {
  float relative = SOURCE_POSITION(m.p).w;
  vec3 x = m.own.x, v = damping ? m.own.v : SOURCE_VELOCITY(m.p).xyz;
  step_particle(s, spring_force(c, m), relative, x, v);
  position_next[m.p] = vec4(x, relative);
  velocity_next[m.p] = vec4(v, 0.0);
}

#include "../shared/march.glsl"
