#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Tells of each patch whether some particle of it may have another near that is not beside it on the cloth:
// where it and those beside it are not nearly flat, or where the box of a patch farther away on the cloth
// is near. The particles of all others look at their neighbours only. Each invocation writes its own patch:
// no races. Source: docs/effects.md "Self-collision".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, patches)
READS(uint, cells)
READS(uint, cell_members)
READS(uint, collision_state)
WRITES(uint, patch_listed)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/patches.glsl"
#include "../shared/patch_boxes.glsl"
#include "../shared/search_reach.glsl"

bool is_near(OwnPatch own, uint other, Patches grid, real3 low, real3 high, real search) {
  uint x = other % grid.nx, y = other / grid.nx;
  bool beside = x + 1u >= own.x && x <= own.x + 1u && y + 1u >= own.y && y <= own.y + 1u &&
                y / grid.ny == own.y / grid.ny;
  if (beside) return false;
  precise real3 before = patch_low(other) - high, after = low - patch_high(other);
  real3 gap = max(before, after);
  return max(max(gap.x, gap.y), gap.z) < search;
}

bool finds(Cells c, Patches grid, OwnPatch own, real search) {
  real3 low = patch_low(own.patch_index), high = patch_high(own.patch_index);
  CellRange range = cells_around(c, low, high, search);
  if (!range.whole) return true;
  for (int k = range.first.z; k <= range.last.z; ++k)
    for (int j = range.first.y; j <= range.last.y; ++j)
      for (int i = range.first.x; i <= range.last.x; ++i) {
        uint bucket = bucket_of(c, ivec3(i, j, k)), end = cells[bucket + 1u];
        for (uint slot = cells[bucket]; slot < end; ++slot)
          if (is_near(own, cell_members[slot], grid, low, high, search)) return true;
      }
  return false;
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  OwnPatch own;
  if (!own_patch(c, grid, own)) return;
  bool listed = false;
  if (covered(c, patch_low(own.patch_index)) && covered(c, patch_high(own.patch_index))) {
    real search = search_distance();
    bool nearly_flat_here = patches[2u * own.patch_index].w != 0.0 && search <= collision[0].patch_search_m;
    listed = !nearly_flat_here || finds(c, grid, own, search);
  }
  patch_listed[own.patch_index] = listed ? 1u : 0u;
}
