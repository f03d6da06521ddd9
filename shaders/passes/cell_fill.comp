#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Last third of the counting sort: every block takes a slot of its bucket, counting its end down to its
// start. Which of its slots depends on who came first; cell_sort puts that right.

#include "../shared/cells.glsl"
READS_VECTORS(blocks)
READS  (uint, collision_state)
UPDATES(uint, cells)
WRITES (uint, cell_arrivals)

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
  uint slot = atomicAdd(cells[bucket], 0xffffffffu) - 1u;
  cell_arrivals[slot] = own;
}
