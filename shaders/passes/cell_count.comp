#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../shared/pass.glsl"

// First third of the counting sort: the box of each patch, and how many patches each bucket of the grid
// holds. And the longest edge and the widest box, by which the searches know how far to look; and where the
// cloth is spread out and where it bends. Counts are integers added atomically: their sums do not depend
// on the order, nor do the greatest. Source: Green 2008, Particle simulation using CUDA, "Building the grid
// using atomic operations".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, position)
UPDATES(uint, collision_state)
WRITES(real4, patches)
UPDATES(uint, cells)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/surface.glsl"
#include "../shared/patches.glsl"
#include "../shared/folds.glsl"

// The longest squared edge from a particle to the right, below, and below to the left.
real longest_edge(Cells c, OwnPatch own, uvec2 at, real3 x) {
  bvec2 more = lessThan(at, own.last);
  precise real3 d0 = position_at(c, own, uvec2(min(at.x + 1u, own.last.x), at.y)) - x;
  precise real3 d1 = position_at(c, own, uvec2(at.x, min(at.y + 1u, own.last.y))) - x;
  real longest = max(squared_length(d0), squared_length(d1));
  if (!more.y || at.x == 0u) return longest;
  precise real3 d2 = position_at(c, own, uvec2(at.x - 1u, at.y + 1u)) - x;
  return max(longest, squared_length(d2));
}

// Whether a particle of the patch may have another on its list that is not beside it but of this patch or one
// beside it. `mine` are the patch's particles, as many as the cloth has.
bool close(Cells c, OwnPatch own, real3 mine[4]) {
  bool found = false;
  ivec2 low = max(ivec2(own.low) - 2, ivec2(0)), high = min(ivec2(own.low) + 3, ivec2(own.last));
  [[dont_unroll]] for (int j = low.y; j <= high.y; ++j)
    [[dont_unroll]] for (int i = low.x; i <= high.x; ++i) {
      real3 x = position_at(c, own, uvec2(i, j));
      [[unroll]] for (int k = 0; k < 4; ++k) {
        ivec2 at = ivec2(own.low) + ivec2(k % 2, k / 2), off = abs(ivec2(i, j) - at);
        precise real3 d = x - mine[k];
        found = found || (max(off.x, off.y) > 1 && all(lessThanEqual(at, ivec2(own.last))) &&
                          squared_length(d) < collision[0].patch_search_squared_m2);
      }
    }
  return found;
}

void raise(uint word, real value) {
  uint bits = floatBitsToUint(float(value));
  if (bits > collision_state[word]) atomicMax(collision_state[word], bits);
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  OwnPatch own;
  if (!own_patch(c, grid, own)) return;
  real3 mine[4], low, high;
  real longest = 0.0;
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    uvec2 at = min(own.low + uvec2(k % 2u, k / 2u), own.last);  // at the cloth's end one of them again
    mine[k] = position_at(c, own, at);
    low = k == 0u ? mine[k] : min(low, mine[k]);
    high = k == 0u ? mine[k] : max(high, mine[k]);
    longest = max(longest, longest_edge(c, own, at, mine[k]));
  }
  patches[2u * own.patch_index] = real4(low, close(c, own, mine) ? 0.0 : 1.0);
  patches[2u * own.patch_index + 1u] = real4(high, real(bends(c, own)));
  precise real3 wide = high - low;
  raise(kLongestEdge, longest);
  if (covered(c, low) && covered(c, high)) raise(kWidestPatch, max(max(wide.x, wide.y), wide.z));
  atomicAdd(cells[bucket_of(c, cell_of_box(c, low, high, own.patch_index))], 1u);
}
