#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Makes the fill stable: within its bucket a block stands where its index says, whoever came first.
// Each invocation counts the smaller indices of its own bucket and writes one slot, its own: no races.

#include "../shared/cells.glsl"
READS_VECTORS(blocks)
READS (uint, collision_state)
READS (uint, cells)
READS (uint, cell_arrivals)
WRITES(uint, cell_members)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/patches.glsl"
#include "../shared/block_boxes.glsl"

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  uint own;
  if (!own_block_index(grid, own)) return;
  uint bucket = bucket_of(c, cell_of_block(c, own));
  uint start = cells[bucket], end = cells[bucket + 1u], smaller = 0u;
  for (uint slot = start; slot < end; ++slot) smaller += cell_arrivals[slot] < own ? 1u : 0u;
  cell_members[start + smaller] = own;
}
