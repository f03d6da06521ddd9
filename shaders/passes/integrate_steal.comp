#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "../shared/pass.glsl"

// `integrate` by strips that are taken, not dealt: each workgroup has a queue of tiles (a subgroup's strips)
// and, when it is empty, takes from the others'. Software devices deal workgroups to threads in equal parts,
// and wait for the slowest. No workgroup waits for another. The bits are those of integrate.comp.
// Source: docs/float-form.md; measured in docs/performance.md.

READS (vec4, substeps)
READS_TEXELS(position)
READS_TEXELS(velocity)
UPDATES(vec4, position_next)
UPDATES(vec4, velocity_next)
UPDATES(uint, queue_heads)  // zero before and after: workgroups done, then tiles taken of each queue

layout(local_size_x_id = 12) in;  // a subgroup
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

const uint kHeadStride = 16u;  // uints: heads on cache lines of their own
const uint kNone = 0xffffffffu;

uint across, tiles, queues, in_queue;  // tiles side by side, in all; queues, tiles of a queue
uint queue, visited;                   // the queue taken from; how many have been found empty

// The next tile of the queue, or of the first one after it that has any; kNone when none has.
uint take() {
  uint tile = kNone;
  while (tile == kNone && visited < queues) {
    uint head = 0u;
    if (subgroupElect()) head = atomicAdd(queue_heads[(queue + 1u) * kHeadStride], 1u);
    head = subgroupBroadcastFirst(head);
    uint wanted = queue * in_queue + head;
    if (head < in_queue && wanted < tiles) {
      tile = wanted;
    } else {
      ++visited;
      queue = queue + 1u == queues ? 0u : queue + 1u;
    }
  }
  return tile;
}

// The last workgroup to end leaves the heads at zero.
void end_queues() {
  memoryBarrierBuffer();
  if (!subgroupElect() || atomicAdd(queue_heads[0], 1u) + 1u != queues) return;
  memoryBarrierBuffer();
  for (uint q = 0u; q <= queues; ++q) queue_heads[q * kHeadStride] = 0u;
}

void main() {
#ifdef WEFT_REACH
  if (is_torn()) return;
#endif
  hold_params();
  Step s = step_of(row_index * params.row_stride);
  const uint wide = columns * gl_SubgroupSize;
  across = (params.nx + wide - 1u) / wide;
  tiles = across * ((params.ny + rows - 1u) / rows);
  queues = gl_NumWorkGroups.x;
  in_queue = (tiles + queues - 1u) / queues;
  queue = gl_WorkGroupID.x;
  visited = 0u;
  // No invocation may run more than 65 535 turns of all its loops (docs/performance.md). Twice its share
  // is the most a workgroup takes, so that all together take every tile whoever is fast.
  uint left = 2u * in_queue;
  uint tile = take();
  if (tile != kNone) {
    do {
      uint first = (tile % across) * wide + gl_SubgroupInvocationID * columns, begin = tile / across * rows;
      prepare_columns(first);
      march_strip(s, first, begin, min(begin + rows, params.ny));
      tile = --left == 0u ? kNone : take();
    } while (tile != kNone);
  }
  tell_reach();
  tell_kicks();
  end_queues();
}
