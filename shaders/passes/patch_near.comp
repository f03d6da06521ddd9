#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../shared/pass.glsl"

// Tells of each patch whether some particle of it may have another near that is not beside it on the cloth:
// where it and those beside it are not spread out, or where the box of a patch farther away on the cloth
// is near. And which of its particles look at their neighbours: those at a folded cell, and all near a
// crease. An invocation asks for two by two patches at once, and for each of them where that finds something.
// It writes its own patches: no races. Source: docs/effects.md "Self-collision".

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS_VECTORS(patches)
READS_VECTORS(blocks)
READS(uint, cells)
READS(uint, cell_members)
UPDATES(uint, collision_state)
WRITES(uint, patch_listed)
WRITES(uint, lookers)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/patches.glsl"
#include "../shared/block_boxes.glsl"
#include "../shared/patch_boxes.glsl"
#include "../shared/search_reach.glsl"

// With the blocks beside it on the cloth.
Block wider(Patches grid, Block block) {
  uvec2 least = uvec2(0u, block.first_row);
  return Block(max(block.low, least + 2u) - 2u,
               min(block.low + 3u, least + uvec2(grid.nx, grid.ny) - 1u), block.first_row);
}

bool within(uint other, real3 low, real3 high, real search) {
  return gap_between(patch_low(other), patch_high(other), low, high) < search;
}

// What is far is told by its box first: to divide an index is dear on devices that do it lane by lane.
bool is_near(OwnPatch own, uint other, Patches grid, real3 low, real3 high, real search) {
  if (!within(other, low, high, search)) return false;
  uvec2 at = uvec2(other % grid.nx, other / grid.nx);
  bool beside = at.x + 1u >= own.x && at.x <= own.x + 1u && at.y + 1u >= own.y && at.y <= own.y + 1u;
  return at.y / grid.ny != own.y / grid.ny || !beside;
}

bool patch_covered(Cells c, uint patch_index) {
  return covered(c, patch_low(patch_index)) && covered(c, patch_high(patch_index));
}

// Whether a block, by its index, is the own one or beside it on the cloth.
bool beside_block(Patches grid, uvec2 own, uint other) {
  uvec2 each = blocks_of(grid), at = uvec2(other % each.x, other / each.x);
  bool near = at.x + 1u >= own.x && at.x <= own.x + 1u && at.y + 1u >= own.y && at.y <= own.y + 1u;
  return near && (sheet_rows == 0u || at.y / each.y == own.y / each.y);
}

// Along x, then y, then z; behind the last one beyond range.last.z.
ivec3 next_cell(ivec3 cell, CellRange range) {
  ++cell.x;
  if (cell.x > range.last.x) cell = ivec3(range.first.x, cell.y + 1, cell.z);
  if (cell.y > range.last.y) cell = ivec3(cell.x, range.first.y, cell.z + 1);
  return cell;
}

// Whether no block but those beside it is near the block of this column and row.
bool is_alone(Cells c, Patches grid, uvec2 own, real search) {
  uint index = own.y * blocks_of(grid).x + own.x;
  real3 low = block_low(index), high = block_high(index);
  if (!covered(c, low) || !covered(c, high)) return false;
  CellRange range = cells_around(c, low, high, search);
  if (!range.whole) return false;
  // One loop over cells and what is in them, so that invocations that a device runs in step do not wait for
  // the fullest cell of each turn.
  ivec3 cell = range.first;
  uint slot = 0u, end = 0u;
  while (slot < end || cell.z <= range.last.z) {
    if (slot == end) {
      uint bucket = bucket_of(c, cell);
      slot = cells[bucket];
      end = cells[bucket + 1u];
      cell = next_cell(cell, range);
    }
    if (slot < end) {
      uint other = cell_members[slot];
      ++slot;
      bool near = gap_between(block_low(other), block_high(other), low, high) < search;
      if (near && !beside_block(grid, own, other)) return false;
    }
  }
  return true;
}

bool block_has(Cells c, Patches grid, OwnPatch own, uint block_index, real3 low, real3 high, real search) {
  uint across = blocks_of(grid).x;
  Block block = block_at(grid, uvec2(block_index % across, block_index / across));
  for (uint y = block.low.y; y <= block.high.y; ++y)
    for (uint x = block.low.x; x <= block.high.x; ++x)
      if (is_near(own, y * grid.nx + x, grid, low, high, search)) return true;
  return false;
}

bool finds(Cells c, Patches grid, OwnPatch own, real search) {
  real3 low = patch_low(own.patch_index), high = patch_high(own.patch_index);
  CellRange range = cells_around(c, low, high, search);
  if (!range.whole) return true;
  for (int k = range.first.z; k <= range.last.z; ++k)
    for (int j = range.first.y; j <= range.last.y; ++j)
      for (int i = range.first.x; i <= range.last.x; ++i) {
        uint bucket = bucket_of(c, ivec3(i, j, k)), end = cells[bucket + 1u];
        for (uint slot = cells[bucket]; slot < end; ++slot) {
          uint other = cell_members[slot];
          bool near = gap_between(block_low(other), block_high(other), low, high) < search;
          if (near && block_has(c, grid, own, other, low, high, search)) return true;
        }
      }
  return false;
}

// Of the five by five cells, five in a row, those of a patch that are folded; its first is at `at`.
uint cells_at(uint bits, ivec2 at) {
  uint cells_folded = 0u;
  [[unroll]] for (int k = 0; k < 4; ++k) {
    ivec2 cell = at + ivec2(k % 2, k / 2);
    bool inside = all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, ivec2(5)));
    if (inside && (bits >> k & 1u) != 0u) cells_folded |= 1u << (5 * cell.y + cell.x);
  }
  return cells_folded;
}

// What the block and those beside it say of the block's four patches, row by row.
struct Surroundings {
  uint found;    // a bit for each that has another near it, but not beside it, among them
  uint folds;    // of the five by five cells at its particles
  uint creases;  // of the four by four patches
};

Surroundings look_around(Patches grid, Block block, Block region, real search) {
  real3 low[4], high[4];
  uvec2 at[4];
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    at[k] = min(block.low + uvec2(k % 2u, k / 2u), block.high);  // at the cloth's end one of them again
    low[k] = patch_low(at[k].y * grid.nx + at[k].x);
    high[k] = patch_high(at[k].y * grid.nx + at[k].x);
  }
  Surroundings seen = Surroundings(0u, 0u, 0u);
  for (uint y = region.low.y; y <= region.high.y; ++y)
    for (uint x = region.low.x; x <= region.high.x; ++x) {
      uint other = y * grid.nx + x;
      real3 other_low = patch_low(other), other_high = patch_high(other);
      [[unroll]] for (uint k = 0u; k < 4u; ++k) {
        bool beside = x + 1u >= at[k].x && x <= at[k].x + 1u && y + 1u >= at[k].y && y <= at[k].y + 1u;
        if (!beside && gap_between(other_low, other_high, low[k], high[k]) < search) seen.found |= 1u << k;
      }
      uvec2 place = uvec2(x, y) + 1u - block.low;  // among the four by four
      if (any(greaterThan(place, uvec2(3u)))) continue;
      uint bits = folds_in(other);
      seen.folds |= cells_at(bits, 2 * ivec2(place) - 1);
      if ((bits & kCreased) != 0u) seen.creases |= 1u << (4u * place.y + place.x);
    }
  return seen;
}

// The bits of the patch's particles that are at a folded cell; of all of them where a diagonal nearby is
// creased. 99: two by two of five; 0x777: three by three of four.
uint looks_beside(Surroundings seen, uvec2 place) {
  if ((seen.creases >> (4u * place.y + place.x) & 0x777u) != 0u) return kCreaseBeside | 15u * kLooksBeside;
  uint looks = 0u;
  [[unroll]] for (uint k = 0u; k < 4u; ++k) {
    uvec2 particle = 2u * place + uvec2(k % 2u, k / 2u);
    if ((seen.folds >> (5u * particle.y + particle.x) & 99u) != 0u) looks |= kLooksBeside << k;
  }
  return looks;
}

// Puts those of the patch's particles that look for others where the passes find them that make their lists.
void tell_lookers(Cells c, OwnPatch own, uint looks) {
  uint who = (looks & kLooksFar) != 0u ? 15u : looks / kLooksBeside & 15u;
  if (own.low.x == own.last.x) who &= 5u;  // at the cloth's ends a patch has fewer
  if (own.low.y == own.last.y) who &= 3u;
  if (who == 0u) return;
  uint count = uint(bitCount(who)), slot = atomicAdd(collision_state[kLookers], count);
  uint groups = (slot + count + kCollisionGroup - 1u) / kCollisionGroup;
  atomicMax(collision_state[kNearGroups], min(groups, kLookGroupsMax));
  for (; who != 0u; who &= who - 1u) {
    uint k = uint(findLSB(who));
    lookers[slot] = (own.first_row + own.low.y + k / 2u) << c.column_bits | (own.low.x + k % 2u);
    ++slot;
  }
}

void main() {
  if (collision_state[kListGroups] == 0u) return;
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  uint index;
  if (!own_block_index(grid, index)) return;
  uvec2 at = gl_GlobalInvocationID.xy;
  Block block = block_at(grid, at);
  Block region = wider(grid, block);
  real search = search_distance();
  bool overlooks = !(search <= collision[0].patch_search_m);  // edges are longer than expected
  bool alone = !overlooks && is_alone(c, grid, at, search);
  Surroundings seen = look_around(grid, block, region, search);
  for (uint y = block.low.y; y <= block.high.y; ++y)
    for (uint x = block.low.x; x <= block.high.x; ++x) {
      OwnPatch own = patch_at(c, grid, x, y);
      uvec2 place = uvec2(x, y) - block.low;
      bool far = false;
      if (patch_covered(c, own.patch_index)) {
        far = overlooks || load_patches(2u * own.patch_index).w == 0.0;
        bool found = (seen.found >> (2u * place.y + place.x) & 1u) != 0u;
        if (!far) far = alone ? found : finds(c, grid, own, search);
      }
      uint looks = (far ? kLooksFar : 0u) | looks_beside(seen, place);
      patch_listed[own.patch_index] = looks;
      tell_lookers(c, own, looks);
    }
}
