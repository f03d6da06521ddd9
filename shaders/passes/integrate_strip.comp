#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../shared/pass.glsl"

// `integrate` by strips: an invocation takes `columns` × `rows` particles, marches down with the rows in
// registers and evaluates each spring inside its strip once. It writes its own particles of the *_next
// buffers and reads only the others: no races. The bits are those of integrate.comp.
// Source: docs/float-form.md; measured in docs/performance.md.

READS (vec4, substeps)
READS_TEXELS(position)
READS_TEXELS(velocity)
UPDATES(vec4, position_next)
UPDATES(vec4, velocity_next)

layout(local_size_x_id = 12) in;  // chosen by the host, as are columns and rows
layout(push_constant) uniform Push { uint row_index; };  // which row of the substep table

#include "../shared/effects.glsl"
#include "../shared/held_params.glsl"
layout(constant_id = 10) const uint columns = 4u;
layout(constant_id = 11) const uint rows = 16u;

#define SOURCE_POSITION(p) position_texel(p)
#define SOURCE_VELOCITY(p) velocity_texel(p)

void put(uint p, vec4 x, vec4 v) {
  position_next[p] = x;
  velocity_next[p] = v;
}

#include "../shared/reach.glsl"
#include "../shared/force.glsl"
#define LATE_SPHERES
#include "../shared/contact.glsl"
#include "../shared/spread.glsl"
#include "../shared/kick.glsl"
#include "../shared/step_particle.glsl"
#include "../shared/strip.glsl"

void main() {
#ifdef WEFT_REACH
  if (is_torn()) return;
#endif
  hold_params();
  Step s = step_of(row_index * params.row_stride);
  uint first = gl_GlobalInvocationID.x * columns, begin = gl_GlobalInvocationID.y * rows;
  if (first >= params.nx || begin >= params.ny) return;
  prepare_columns(first);
  march_strip(s, first, begin, min(begin + rows, params.ny));
  tell_reach();
  tell_kicks();
}
