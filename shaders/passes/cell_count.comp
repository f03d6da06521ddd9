#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// First third of the counting sort: the box of each patch, and how many patches each bucket of the grid
// holds. And the longest edge and the widest box, by which the searches know how far to look; and whether the
// patch and those beside it are nearly flat. Counts are integers added atomically: their sums do not depend
// on the order, nor do the greatest. Source: Green 2008, Particle simulation using CUDA, "Building the grid
// using atomic operations".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, position)
UPDATES(uint, collision_state)
WRITES(real4, patches)
UPDATES(uint, cells)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/nearly_flat.glsl"
#include "../shared/patches.glsl"

real3 at(Cells c, OwnPatch own, uint i, uint j) { return position[(own.first_row + j) * c.nx + i].xyz; }

// The longest squared edge from a particle to the right, below, and below to the left.
real longest_edge(Cells c, OwnPatch own, uint i, uint j, real3 x) {
  bool right = i < own.last.x, below = j < own.last.y;
  uint p = (own.first_row + j) * c.nx + i;
  precise real3 d0 = position[right ? p + 1u : p].xyz - x;
  precise real3 d1 = position[below ? p + c.nx : p].xyz - x;
  precise real3 d2 = position[below && i > 0u ? p + c.nx - 1u : p].xyz - x;
  return max(max(squared_length(d0), squared_length(d1)), squared_length(d2));
}

void raise(uint word, real value) {
  uint bits = floatBitsToUint(float(value));
  if (bits > collision_state[word]) atomicMax(collision_state[word], bits);
}

// Whether no two particles that are not beside each other come near within the patch and those beside it.
bool flat_around(Cells c, OwnPatch own) {
  uvec2 low = max(own.low, uvec2(2u)) - 2u, high = min(own.low + 3u, own.last);
  uvec2 to = min(own.low + 1u, own.last);
  precise real3 along = at(c, own, to.x, own.low.y) - at(c, own, to.x - 1u, own.low.y);
  precise real3 down = at(c, own, own.low.x, to.y) - at(c, own, own.low.x, to.y - 1u);
  uvec2 first = uvec2(0u, own.first_row);
  return nearly_flat(c, first + low, first + high, along, down, collision[0].patch_flat_m);
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  OwnPatch own;
  if (!own_patch(c, grid, own)) return;
  real3 low = at(c, own, own.low.x, own.low.y), high = low;
  real longest = 0.0;
  uvec2 to = min(own.low + 1u, own.last);
  for (uint j = own.low.y; j <= to.y; ++j)
    for (uint i = own.low.x; i <= to.x; ++i) {
      real3 x = at(c, own, i, j);
      low = min(low, x);
      high = max(high, x);
      longest = max(longest, longest_edge(c, own, i, j, x));
    }
  patches[2u * own.patch_index] = real4(low, flat_around(c, own) ? 1.0 : 0.0);
  patches[2u * own.patch_index + 1u] = real4(high, 0.0);
  precise real3 wide = high - low;
  raise(kLongestEdge, longest);
  if (covered(c, low) && covered(c, high)) raise(kWidestPatch, max(max(wide.x, wide.y), wide.z));
  atomicAdd(cells[bucket_of(c, cell_of_box(c, low, high, own.patch_index))], 1u);
}
