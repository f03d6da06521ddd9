#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../shared/pass.glsl"

// `integrate`, several substeps in one dispatch: a workgroup owns a band of rows and recomputes, two rows
// a substep and side, the halo that its neighbours own. What lies between two substeps is in a scratch of
// the band's own: no workgroup waits for another. The bits are those of integrate.comp.
// Source: docs/float-form.md; measured in docs/performance.md.

READS (vec4, substeps)
READS_TEXELS(position)
READS_TEXELS(velocity)
WRITES(vec4, position_next)
WRITES(vec4, velocity_next)
// The scratch is written as a block and read as texels, whichever is cheaper; both are coherent, because
// what one invocation writes others read after the barrier.
layout(scalar, set = 0, binding = kBinding_band_scratch) coherent writeonly buffer Block_band_scratch {
  vec4 band_scratch[];
};
layout(set = 0, binding = kBinding_band_texels, rgba32f) coherent readonly uniform imageBuffer band_texels;

layout(local_size_x_id = 12) in;
layout(push_constant) uniform Push {
  uint row_index;      // which row of the substep table the first substep has
  uint substep_count;  // 2 … most_substeps
};

#include "../shared/effects.glsl"
#include "../shared/held_params.glsl"
layout(constant_id = 10) const uint columns = 4u;
layout(constant_id = 11) const uint most_substeps = 4u;

// The scratch holds two halves of the band's rows; a particle is its position, then its velocity.
uint scratch_from, scratch_to;  // where particle 0 of the cloth would lie, modulo 2^32
bool from_scratch;              // false in the first substep, a constant in each copy of the march

vec4 scratch_or_position(uint p) {
  if (!from_scratch) return position_texel(p);
  return imageLoad(band_texels, int(scratch_from + 2u * p));
}
vec4 scratch_or_velocity(uint p) {
  if (!from_scratch) return velocity_texel(p);
  return imageLoad(band_texels, int(scratch_from + 2u * p + 1u));
}
#define SOURCE_POSITION(p) scratch_or_position(p)
#define SOURCE_VELOCITY(p) scratch_or_velocity(p)

void put(uint p, vec4 x, vec4 v) {
  band_scratch[scratch_to + 2u * p] = x;
  band_scratch[scratch_to + 2u * p + 1u] = v;
}

#include "../shared/force.glsl"
#include "../shared/contact.glsl"
#include "../shared/kick.glsl"
#include "../shared/step_particle.glsl"
#include "../shared/strip.glsl"

// Waits until the workgroup has written a half, and makes it the one to read.
void turn_over() {
  memoryBarrier();
  barrier();
  uint written = scratch_to;
  scratch_to = scratch_from;
  scratch_from = written;
}

void march_band(Step s, uint begin, uint end) {
  const uint stride = gl_WorkGroupSize.x * columns;
  for (uint first = gl_LocalInvocationID.x * columns; first < params.nx; first += stride) {
    prepare_columns(first);
    march_strip(s, first, begin, end);
  }
}

void main() {
  hold_params();
  Step s = step_of(row_index * params.row_stride);
  uint band_rows = (params.ny + gl_NumWorkGroups.y - 1u) / gl_NumWorkGroups.y;
  uint begin = min(gl_WorkGroupID.y * band_rows, params.ny), end = min(begin + band_rows, params.ny);
  uint reach = 2u * (substep_count - 1u);  // rows beyond the band that the later substeps ask of this one
  uint low = begin - min(begin, reach);
  uint half_size = 2u * params.nx * (band_rows + 4u * (most_substeps - 1u));
  scratch_to = gl_WorkGroupID.y * 2u * half_size - 2u * params.nx * low;
  scratch_from = scratch_to + half_size;

  from_scratch = false;
  if (begin < end) march_band(s, low, min(end + reach, params.ny));
  from_scratch = true;
  for (uint k = 1u; k < substep_count; ++k) {
    turn_over();
    reach -= 2u;
    s = step_of((row_index + k) * params.row_stride);
    if (begin < end) march_band(s, begin - min(begin, reach), min(end + reach, params.ny));
  }
  turn_over();
  for (uint p = begin * params.nx + gl_LocalInvocationID.x; p < end * params.nx; p += gl_WorkGroupSize.x) {
    position_next[p] = scratch_or_position(p);
    velocity_next[p] = scratch_or_velocity(p);
  }
}
