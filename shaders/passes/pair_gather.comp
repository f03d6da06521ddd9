#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Lists, for every particle whose patch has something near, those that could come nearer than their limit
// before the lists are made anew: the particles of the patches in the cells round it that are within limit
// + skin, but for its eight neighbours on the cloth, which are in the springs' charge. A bucket may hold
// patches of several cells, and each is taken only where its own cell is asked for, so none is taken twice.
// Each invocation writes its own particle's list: no races. Source: Green 2008,
// Particle simulation using CUDA; Verlet 1967.

#include "../shared/cells.glsl"
READS_VECTORS(position)
READS(uint, cells)
READS(uint, cell_members)
READS_VECTORS(patches)
READS_VECTORS(blocks)
READS(uint, patch_listed)
UPDATES(uint, collision_state)
READS(uint, lookers)
WRITES(uint, pair_count)
WRITES(uint, pair_places)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/patches.glsl"
#include "../shared/block_boxes.glsl"
#include "../shared/patch_boxes.glsl"
#include "../shared/search_reach.glsl"
#include "../shared/beside.glsl"

void add(Cells c, Own own, real3 x, uvec2 other, inout uint found) {
  uint place = other.y << c.column_bits | other.x;
  precise real3 d = load_position(other.y * c.nx + other.x).xyz - x;
  if (!(squared_length(d) < collision[0].limits[limit_row(c, own, place)].z)) return;
  if (found < collision[0].capacity) pair_places[found * c.count + own.particle] = place;
  ++found;
}

void add_patch(Cells c, Patches grid, Own own, real3 x, uint patch_index, inout uint found) {
  uvec2 low = corner_of(grid, patch_index), high = far_corner_of(c, low);
  for (uint j = low.y; j <= high.y; ++j)
    for (uint i = low.x; i <= high.x; ++i)
      if (!beside(own, uvec2(i, j))) add(c, own, x, uvec2(i, j), found);
}

void add_block(Cells c, Patches grid, Own own, real3 x, uint block_index, inout uint found) {
  uint across = blocks_of(grid).x;
  Block block = block_at(grid, uvec2(block_index % across, block_index / across));
  for (uint j = block.low.y; j <= block.high.y; ++j)
    for (uint i = block.low.x; i <= block.high.x; ++i)
      if (patch_reaches(j * grid.nx + i, x, collision[0].pair_reach_m))
        add_patch(c, grid, own, x, j * grid.nx + i, found);
}

void search_around(Cells c, Patches grid, Own own, real3 x, inout uint found) {
  CellRange range = cells_around(c, x, x, collision[0].pair_reach_m);
  for (int k = range.first.z; k <= range.last.z; ++k)
    for (int j = range.first.y; j <= range.last.y; ++j)
      for (int i = range.first.x; i <= range.last.x; ++i) {
        ivec3 cell = ivec3(i, j, k);
        uint bucket = bucket_of(c, cell), end = cells[bucket + 1u];
        for (uint slot = cells[bucket]; slot < end; ++slot) {
          uint other = cell_members[slot];
          if (block_reaches(other, x, collision[0].pair_reach_m) && cell_of_block(c, other) == cell)
            add_block(c, grid, own, x, other, found);
        }
      }
}

void make_list(Cells c, Patches grid, Own own) {
  real3 x = load_position(own.particle).xyz;
  if (!covered(c, x) || (patch_listed[patch_with(grid, own)] & kLooksFar) == 0u) return;
  uint found = 0u;
  search_around(c, grid, own, x, found);
  uint kept = min(found, collision[0].capacity);
  pair_count[own.particle] = kept;
  if (kept > 0u) {
    atomicOr(collision_state[kPairsListed], 1u);
    atomicOr(collision_state[kContactGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup);
  }
  if (found > kept) atomicAdd(collision_state[kPairsDropped], found - kept);
}

void main() {
  if (collision_state[kNearGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  uint count = collision_state[kLookers], stride = gl_NumWorkGroups.x * kCollisionGroup;
  for (uint k = gl_GlobalInvocationID.x; k < count; k += stride) make_list(c, grid, own_at(c, lookers[k]));
}
