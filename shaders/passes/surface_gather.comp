#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Lists the triangles near every particle and the pairs of edges near each other, before the lists are made
// anew. Of the corners of two primitives that are within reach, one pair is within search_squared of each
// other, and the nearest such pair finds them: the particle whose turn it is owns the entry, so that none is
// listed twice. Primitives that share a corner are not listed. Neighbours are passed over where the cloth is
// not folded, and all others where its patch has nothing else near: docs/effects.md "Self-collision" says why
// nothing is missed. Each invocation writes its own particle's list: no races. Source: Bridson, Fedkiw and
// Anderson 2002, Robust treatment of collisions, contact and friction for cloth animation, section 6 (which
// pairs); the grid: Green 2008.

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS_VECTORS(position)
READS(uint, cells)
READS(uint, cell_members)
READS_VECTORS(patches)
READS_VECTORS(blocks)
READS(uint, patch_listed)
READS(uint, lookers)
UPDATES(uint, collision_state)
WRITES(uint, surface_count)
WRITES(uint, surface_pairs)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/surface.glsl"
#include "../shared/patches.glsl"
#include "../shared/block_boxes.glsl"
#include "../shared/patch_boxes.glsl"
#include "../shared/search_reach.glsl"
#include "../shared/beside.glsl"

real3 at(Cells c, ivec2 ij) { return load_position(uint(ij.y) * c.nx + uint(ij.x)).xyz; }

real squared_between(real3 a, real3 b) {
  precise real3 d = b - a;
  return squared_length(d);
}

// Whether the corners (a, b) stand for two primitives rather than (e, f), which are their corners as well.
bool stands_for(real ab, uint place_a, uint place_b, real ef, uint place_e, uint place_f) {
  if (ab != ef) return ab < ef;
  uint low_ab = min(place_a, place_b), low_ef = min(place_e, place_f);
  if (low_ab != low_ef) return low_ab < low_ef;
  return max(place_a, place_b) < max(place_e, place_f);
}

uint place_of(Cells c, ivec2 ij) { return uint(ij.y) << c.column_bits | uint(ij.x); }

// Whether the cell at a column and row is folded.
bool folded_cell(Patches grid, uvec2 cell) {
  uint j = own_row(cell.y);
  uint bits = folds_in((cloth_of(cell.y) * grid.ny + j / 2u) * grid.nx + cell.x / 2u);
  return (bits >> (j % 2u * 2u + cell.x % 2u) & 1u) != 0u;
}

// Whether all cells that have both the particle and one beside it are folded.
bool folded_between(Cells c, Patches grid, Own own, uvec2 other) {
  uint top = own.j - own_row(own.j), bottom = top + rows_of_cloth() - 1u;  // of their cloth
  uvec2 here = uvec2(own.i, own.j), low = min(here, other), high = min(low + 1u, uvec2(c.nx - 1u, bottom));
  if (here.x == other.x) low.x = max(low.x, 1u) - 1u;
  if (here.y == other.y) low.y = max(low.y, top + 1u) - 1u;
  for (uint j = low.y; j < high.y; ++j)
    for (uint i = low.x; i < high.x; ++i)
      if (!folded_cell(grid, uvec2(i, j))) return false;
  return true;
}

void keep(Cells c, Own own, uint code, uint place, inout uint found) {
  if (found < collision[0].surface_capacity)
    surface_pairs[found * c.count + own.particle] = code << kSurfaceCodeShift | place;
  ++found;
}

// Of the neighbours of `around`, bit by bit those in whose place it stands for a primitive near x: they are
// no nearer to x, which is not one of them.
uint ring_behind(Cells c, ivec2 around, uint place_around, ivec2 from, uint place, real3 x, real apart) {
  uint bits = 0u;
  for (uint k = 0u; k < 6u; ++k) {
    ivec2 ij = around + kRing[k];
    if (!has_neighbour(c, around, k) || ij == from) continue;
    if (stands_for(apart, place, place_around, squared_between(x, at(c, ij)), place, place_of(c, ij)))
      bits |= 1u << k;
  }
  return bits;
}

// Triangles round `there` whose nearest corner it is.
void add_triangles(Cells c, Own own, real3 x, ivec2 there, uint place, real3 y, uint its_ring,
                   inout uint found) {
  uint bits = its_ring & ((its_ring >> 1u) | (its_ring << 5u));  // both corners behind
  for (; bits != 0u; bits &= bits - 1u) {
    uint k = uint(findLSB(bits));
    real3 xb = at(c, there + kRing[k]), xc = at(c, there + kRing[next_in_ring(k)]);
    real3 weight = closest_in_triangle(x, y, xb, xc);
    real3 d = from_triangle(x, y, xb, xc, weight);
    if (dot3(d, d) < collision[0].surface_reach_squared_m2) keep(c, own, kSurfaceTriangle + k, place, found);
  }
}

// Edges at `there` near edges at the particle, where these two are the nearest ends.
void add_edges(Cells c, Own own, real3 x, ivec2 there, uint place, real3 y, real apart, uint its_ring,
               inout uint found) {
  ivec2 here = ivec2(own.i, own.j);
  uint my_ring = ring_behind(c, here, own.place, there, place, y, apart);
  for (; my_ring != 0u; my_ring &= my_ring - 1u) {
    uint a = uint(findLSB(my_ring));
    ivec2 mine = here + kRing[a];
    real3 xa = at(c, mine);
    for (uint bits = its_ring; bits != 0u; bits &= bits - 1u) {
      uint b = uint(findLSB(bits));
      ivec2 its = there + kRing[b];
      if (its == mine) continue;
      real3 xb = at(c, its);
      if (!stands_for(apart, own.place, place, squared_between(xa, xb), place_of(c, mine), place_of(c, its)))
        continue;
      real s, t;
      closest_on_edges(x, xa, y, xb, s, t);
      real3 d = between_edges(x, xa, y, xb, s, t);
      if (dot3(d, d) < collision[0].surface_reach_squared_m2) keep(c, own, a * 6u + b, place, found);
    }
  }
}

// Particles that are near enough wait here, and are looked at all together, after the search: invocations
// that a device runs in step take the dear part as often as the busiest needs it, not for every particle that
// any of them comes across. If there is no room, the search is made once more for those that were left.
const uint kWaitingMax = 16u;
uint waiting[kWaitingMax];

void look_at_waiting(Cells c, Own own, real3 x, uint count, inout uint found) {
  for (uint w = 0u; w < count; ++w) {
    uint place = waiting[w];
    ivec2 here = ivec2(own.i, own.j), there = ivec2(column_and_row(c, place));
    real3 y = at(c, there);
    real apart = squared_between(x, y);
    uint its_ring = ring_behind(c, there, place, here, own.place, x, apart);
    add_triangles(c, own, x, there, place, y, its_ring, found);
    bool turn = ((own.place ^ place) & 1u) == 0u ? own.place < place : own.place > place;
    if (turn) add_edges(c, own, x, there, place, y, apart, its_ring, found);
  }
}

// One more that is near enough; what comes after the first `done` waits.
void add_waiting(uint place, uint done, inout uint seen) {
  if (seen >= done && seen - done < kWaitingMax) waiting[seen - done] = place;
  ++seen;
}

void search_patch(Cells c, Patches grid, Own own, real3 x, uint patch_index, real search, uint done,
                  inout uint seen) {
  uvec2 low = corner_of(grid, patch_index), high = far_corner_of(c, low);
  for (uint j = low.y; j <= high.y; ++j)
    for (uint i = low.x; i <= high.x; ++i) {
      if (beside(own, uvec2(i, j))) continue;
      if (squared_between(x, at(c, ivec2(i, j))) < search) add_waiting(j << c.column_bits | i, done, seen);
    }
}

void search_block(Cells c, Patches grid, Own own, real3 x, uint block_index, real search, uint done,
                  inout uint seen) {
  uint across = blocks_of(grid).x;
  Block block = block_at(grid, uvec2(block_index % across, block_index / across));
  real distance_m = sqrt(search) * 1.0009765625;
  for (uint j = block.low.y; j <= block.high.y; ++j)
    for (uint i = block.low.x; i <= block.high.x; ++i)
      if (patch_reaches(j * grid.nx + i, x, distance_m))
        search_patch(c, grid, own, x, j * grid.nx + i, search, done, seen);
}

void search_cells(Cells c, Patches grid, Own own, real3 x, CellRange range, real search, uint done,
                  inout uint seen) {
  real distance_m = sqrt(search) * 1.0009765625;
  for (int k = range.first.z; k <= range.last.z; ++k)
    for (int j = range.first.y; j <= range.last.y; ++j)
      for (int i = range.first.x; i <= range.last.x; ++i) {
        ivec3 cell = ivec3(i, j, k);
        uint bucket = bucket_of(c, cell), end = cells[bucket + 1u];
        for (uint slot = cells[bucket]; slot < end; ++slot) {
          uint other = cell_members[slot];
          if (block_reaches(other, x, distance_m) && cell_of_block(c, other) == cell)
            search_block(c, grid, own, x, other, search, done, seen);
        }
      }
}

void search_around(Cells c, Patches grid, Own own, real3 x, uint looks, inout uint found) {
  real search = surface_search_squared();
  CellRange range = cells_around(c, x, x, sqrt(search) * 1.0009765625);
  bool far = (looks & kLooksFar) != 0u, creased = (looks & kCreaseBeside) != 0u;
  bool at_fold = (looks >> (own_row(own.j) % 2u * 2u + own.i % 2u) & kLooksBeside) != 0u;
  if (far && !range.whole) atomicAdd(collision_state[kPairsDropped], 1u);
  uint done = 0u, seen;
  do {
    seen = 0u;
    for (uint k = 0u; k < kBesideCount && at_fold; ++k) {
      if (!has_beside(c, own, k)) continue;
      uvec2 other = beside_at(own, k);
      bool may_reach = creased || folded_between(c, grid, own, other);
      if (may_reach && squared_between(x, at(c, ivec2(other))) < search)
        add_waiting(other.y << c.column_bits | other.x, done, seen);
    }
    if (far) search_cells(c, grid, own, x, range, search, done, seen);
    look_at_waiting(c, own, x, min(seen - done, kWaitingMax), found);
    done += kWaitingMax;
  } while (seen > done);
}

void make_list(Cells c, Patches grid, Own own) {
  real3 x = load_position(own.particle).xyz;
  if (!covered(c, x)) return;
  uint found = 0u;
  search_around(c, grid, own, x, patch_listed[patch_with(grid, own)], found);
  uint kept = min(found, collision[0].surface_capacity);
  surface_count[own.particle] = kept;
  if (found > kept) atomicAdd(collision_state[kPairsDropped], found - kept);
  if (kept == 0u) return;
  atomicOr(collision_state[kPairsListed], 1u);
  atomicOr(collision_state[kContactGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup);
}

void main() {
  Cells c = cells_of_cloth();
  Patches grid = patches_of(c);
  if (gl_GlobalInvocationID.x == 0u) {
    collision_state[kListGroups] = collision_state[kBlockGroups] = 0u;  // done
    collision_state[kNearGroups] = collision_state[kScanGroups] = 0u;
  }
  uint count = collision_state[kLookers], stride = gl_NumWorkGroups.x * kCollisionGroup;
  for (uint k = gl_GlobalInvocationID.x; k < count; k += stride) make_list(c, grid, own_at(c, lookers[k]));
}
