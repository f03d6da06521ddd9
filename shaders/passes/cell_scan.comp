#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Second third of the counting sort: counts become the ends of the buckets (an inclusive prefix sum).
// One workgroup: each invocation adds up a run of buckets of its own, the runs' sums are scanned in shared
// memory, and each invocation writes its run. The lists are made anew rarely; a second level would cost every
// other time a dispatch.

#include "../shared/cells.glsl"
UPDATES(uint, collision_state)
UPDATES(uint, cells)

layout(local_size_x = 256) in;

shared uint sums[gl_WorkGroupSize.x];

void main() {
  if (collision_state[kListGroups] == 0u) return;
  uint lane = gl_LocalInvocationID.x, buckets = collision[0].bucket_mask + 1u;
  uint run = (buckets + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
  uint first = min(lane * run, buckets), end = min(first + run, buckets);
  uint sum = 0u;
  for (uint b = first; b < end; ++b) sum += cells[b];
  sums[lane] = sum;
  barrier();
  for (uint reach = 1u; reach < gl_WorkGroupSize.x; reach <<= 1u) {
    uint before = lane >= reach ? sums[lane - reach] : 0u;
    barrier();
    sums[lane] += before;
    barrier();
  }
  uint total = lane > 0u ? sums[lane - 1u] : 0u;
  for (uint b = first; b < end; ++b) {
    total += cells[b];
    cells[b] = total;
  }
  if (lane == 0u) {
    cells[buckets] = sums[gl_WorkGroupSize.x - 1u];
    collision_state[kListsBuilt] += 1u;
    collision_state[kListsArmed] = 1u;
    collision_state[kLookers] = 0u;  // until patch_near finds them
    collision_state[kPairsListed] = collision_state[kContactGroups] = 0u;  // until a list has an entry
  }
}
