#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Lists the triangles near every particle and the pairs of edges near each other, before the lists are made
// anew. Of the corners of two primitives that are within reach, one pair is within search_squared of each
// other, and the nearest such pair finds them: the particle whose turn it is owns the entry, so that none is
// listed twice. Primitives that share a corner are not listed. Where the cloth round a particle is nearly
// flat, neighbours are passed over: docs/effects.md "Self-collision" says why nothing is missed. Each
// invocation writes its own particle's list: no races. Source: Bridson, Fedkiw and Anderson 2002, Robust
// treatment of collisions, contact and friction for cloth animation, section 6 (which pairs); the grid: Green
// 2008.

#include "../shared/cells.glsl"
#include "../shared/dot.glsl"
READS(real4, position)
READS(uint, cells)
READS(uint, cell_members)
UPDATES(uint, collision_state)
WRITES(uint, surface_count)
WRITES(uint, surface_pairs)
WRITES(uint, surface_bound)

layout(local_size_x = kCollisionGroup) in;

#include "../shared/surface.glsl"

real3 at(Cells c, ivec2 ij) { return position[uint(ij.y) * c.nx + uint(ij.x)].xyz; }

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

// The least factor by which lengths of the patch within two cells of ij are stretched, times a cell; less
// than 0 where that is not known.
real patch_stretch(Cells c, ivec2 ij) {
  int top = ij.y - int(own_row(uint(ij.y))), bottom = top + int(rows_of_cloth()) - 1;  // of its own cloth
  ivec2 low = max(ij - 2, ivec2(0, top)), high = min(ij + 2, ivec2(int(c.nx) - 1, bottom));
  ivec2 right = ivec2(min(ij.x + 1, int(c.nx) - 1), ij.y), below = ivec2(ij.x, min(ij.y + 1, bottom));
  precise real3 along = at(c, right) - at(c, right - ivec2(1, 0));
  precise real3 down = at(c, below) - at(c, below - ivec2(0, 1));
  real off_i = 0.0, off_j = 0.0;
  for (int j = low.y; j <= high.y; ++j)
    for (int i = low.x; i <= high.x; ++i) {
      real3 x = at(c, ivec2(i, j));
      if (i < high.x) {
        precise real3 off = (at(c, ivec2(i + 1, j)) - x) - along;
        off_i = max(off_i, squared_length(off));
      }
      if (j < high.y) {
        precise real3 off = (at(c, ivec2(i, j + 1)) - x) - down;
        off_j = max(off_j, squared_length(off));
      }
    }
  real p = dot3(along, along), s = dot3(down, down), m = dot3(along, down);
  precise real middle = 0.5 * (p + s), half_off = 0.5 * (p - s);
  precise real root = sqrt(half_off * half_off + m * m);
  precise real least = sqrt(max(middle - root, 0.0)), off = sqrt(off_i + off_j);
  precise real stretch = least - off;
  return stretch;
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

// What the particle finds in one cell of the grid, after `seen` others; what comes after the first `done`
// waits.
uint search_cell(Cells c, ivec3 cell, Own own, real3 x, real search, bool flat_here, uint done, uint seen) {
  uint bucket = bucket_of(c, cell), end = cells[bucket + 1u];
  for (uint slot = cells[bucket]; slot < end; ++slot) {
    uint place = cell_members[slot];
    uvec2 other = column_and_row(c, place);
    uint particle = other.y * c.nx + other.x;
    real3 y = position[particle].xyz;
    ivec2 off = abs(ivec2(other) - ivec2(own.i, own.j));
    bool beside = off.x <= 1 && off.y <= 1 && same_cloth(other.y, own.j);
    if (place == own.place || (flat_here && beside)) continue;
    if (!(squared_between(x, y) < search) || cell_of(c, y, particle) != cell) continue;
    if (seen >= done && seen - done < kWaitingMax) waiting[seen - done] = place;
    ++seen;
  }
  return seen;
}

void search_around(Cells c, Own own, real3 x, inout uint found) {
  real longest = real(uintBitsToFloat(collision_state[kLongestEdge]));
  precise real search = (collision[0].surface_reach_squared_m2 + 0.5 * longest) * 1.0009765625;
  precise real far = sqrt(search) * c.inverse_cell_1_m;
  precise real3 middle = x * c.inverse_cell_1_m;
  precise real3 low = floor(middle - far), high = floor(middle + far);
  ivec3 first = ivec3(low), last = ivec3(min(high, low + real(kCellsAcrossMax - 1)));
  if (high != real3(last)) atomicAdd(collision_state[kPairsDropped], 1u);
  bool flat_here = patch_stretch(c, ivec2(own.i, own.j)) >= collision[0].flat_min_m;
  uint done = 0u, seen;
  do {
    seen = 0u;
    for (int k = first.z; k <= last.z; ++k)
      for (int j = first.y; j <= last.y; ++j)
        for (int i = first.x; i <= last.x; ++i)
          seen = search_cell(c, ivec3(i, j, k), own, x, search, flat_here, done, seen);
    look_at_waiting(c, own, x, min(seen - done, kWaitingMax), found);
    done += kWaitingMax;
  } while (seen > done);
}

void main() {
  Cells c = cells_of_cloth();
  Own own;
  if (!own_particle(c, own)) return;
  if (own.particle == 0u) collision_state[kListGroups] = collision_state[kScanGroups] = 0u;
  real3 x = position[own.particle].xyz;
  uint found = 0u;
  if (covered(c, x)) search_around(c, own, x, found);
  uint kept = min(found, collision[0].surface_capacity);
  surface_count[own.particle] = kept;
  surface_bound[own.particle] = kInfinity;
  if (found > kept) atomicAdd(collision_state[kPairsDropped], found - kept);
  if (kept == 0u) return;
  atomicOr(collision_state[kPairsListed], 1u);
  atomicOr(collision_state[kContactGroups], (c.nx + kCollisionGroup - 1u) / kCollisionGroup);
}
