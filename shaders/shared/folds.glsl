// Where the cloth bends so much that it may come within reach of itself from one cell to the next:
// docs/float-form.md "Folds". The including pass declares `position` and includes cells.glsl, dot.glsl,
// surface.glsl and patches.glsl first. Loops are unrolled, so that `around` can lie in registers.

const int kAcross = 4;  // particles of a cell and one more on either side
real3 around[kAcross * kAcross];
bvec2 cell_before, cell_after;  // whether the cloth has cells to the left and above, to the right and below

uvec2 on_cloth(OwnPatch own, ivec2 at) { return uvec2(clamp(at, ivec2(0), ivec2(own.last))); }
real3 position_at(Cells c, OwnPatch own, uvec2 at) {
  return position[(own.first_row + at.y) * c.nx + at.x].xyz;
}

// Of the cell whose first particle is at this column and row.
void look_around(Cells c, OwnPatch own, uvec2 cell) {
  cell_before = greaterThan(cell, uvec2(0u));
  cell_after = lessThan(cell + 1u, own.last);
  [[unroll]] for (int j = 0; j < kAcross; ++j)
    [[unroll]] for (int i = 0; i < kAcross; ++i)
      around[j * kAcross + i] = position_at(c, own, on_cloth(own, ivec2(cell) + ivec2(i, j) - 1));
}

// By column and row; the cell's first particle is (1, 1).
real3 x_at(int i, int j) { return around[j * kAcross + i]; }
bool is_there(int i, int j) {
  return (i > 0 || cell_before.x) && (j > 0 || cell_before.y) && (i < 3 || cell_after.x) &&
         (j < 3 || cell_after.y);
}

// Two unit vectors at right angles, as near as they come to these two.
struct Frame {
  real3 along, down;
};

Frame frame_of(real3 along, real3 down) {
  precise real3 a = along * (1.0 / sqrt(dot3(along, along))), b = down * (1.0 / sqrt(dot3(down, down)));
  precise real3 sum = a + b, rest = a - b;
  real half_root = real(kHalfRoot);
  precise real3 u = sum * (half_root / sqrt(dot3(sum, sum))), w = rest * (half_root / sqrt(dot3(rest, rest)));
  precise real3 first = u + w, second = u - w;
  return Frame(first, second);
}

// Whether a triangle with these edges takes every direction on the cloth to one that goes on by flat_min a
// cell at least where the frame has it: the symmetric part of the map has no eigenvalue below that.
bool goes_along(Frame frame, real3 edge_i, real3 edge_j) {
  real least = collision[0].flat_min_m;
  precise real a = dot3(frame.along, edge_i) - least, b = dot3(frame.down, edge_j) - least;
  precise real m = 0.5 * (dot3(frame.along, edge_j) + dot3(frame.down, edge_i));
  precise real off = m * m, both = a * b;
  return a >= 0.0 && b >= 0.0 && both >= off;
}

// Whether the cloth within a cell of the cell bends so much that surfaces a cell apart on it may be in reach
// of each other. Where the cloth ends the block ends.
bool folded() {
  real3 first = x_at(0, 0), beyond = x_at(3, 0), under = x_at(0, 3), last = x_at(3, 3);
  precise real3 along = (beyond - first) + (last - under), down = (under - first) + (last - beyond);
  Frame frame = frame_of(along, down);
  bool found = false;
  [[unroll]] for (int j = 0; j < 3; ++j)
    [[unroll]] for (int i = 0; i < 3; ++i) {
      precise real3 top = x_at(i + 1, j) - x_at(i, j), side = x_at(i, j + 1) - x_at(i, j);
      precise real3 bottom = x_at(i + 1, j + 1) - x_at(i, j + 1), far = x_at(i + 1, j + 1) - x_at(i + 1, j);
      bool is_cell = is_there(i, j) && is_there(i + 1, j + 1);
      found = found || (is_cell && !(goes_along(frame, top, side) && goes_along(frame, bottom, far)));
    }
  return found;
}

// The ends of the edges that leave a cell's first particle, and its last, and do not touch the diagonal.
const uint kFromFirst[4] = uint[4](2u, 3u, 4u, 5u), kFromLast[4] = uint[4](0u, 1u, 2u, 5u);

// How far a place is along the way from the cell's first particle to its last, times the way's length.
real on_way(real3 way, real3 from, real3 x) {
  precise real3 d = x - from;
  return dot3(way, d);
}

// Whether three planes across that way, flat_min apart, part the diagonal from what leaves the two corners.
bool apart() {
  real3 here = x_at(1, 1), end = x_at(2, 2);
  precise real3 way = end - here;
  real right = on_way(way, here, x_at(2, 1)), below = on_way(way, here, x_at(1, 2));
  real before = 0.0, after = on_way(way, here, end);
  [[unroll]] for (int k = 0; k < 4; ++k) {
    ivec2 a = 1 + kRing[kFromFirst[k]], b = 2 + kRing[kFromLast[k]];
    if (is_there(a.x, a.y)) before = max(before, on_way(way, here, x_at(a.x, a.y)));
    if (is_there(b.x, b.y)) after = min(after, on_way(way, here, x_at(b.x, b.y)));
  }
  precise real room = collision[0].flat_min_m * sqrt(dot3(way, way));
  precise real ahead = min(right, below) - before, behind = after - max(right, below);
  return ahead > room && behind > room;
}

bool triangle_in_reach(real3 p, real3 a, real3 b, real3 corner, real squared) {
  real3 d = from_triangle(p, a, b, corner, closest_in_triangle(p, a, b, corner));
  return dot3(d, d) < squared;
}

bool edge_in_reach(real3 a, real3 b, real3 e, ivec2 end, real squared) {
  if (!is_there(end.x, end.y)) return false;
  real s, t;
  real3 f = x_at(end.x, end.y);
  closest_on_edges(a, b, e, f, s, t);
  real3 d = between_edges(a, b, e, f, s, t);
  return dot3(d, d) < squared;
}

// Whether the diagonal of the cell, or a triangle at it, may be in reach of the other corners or of the edges
// that leave them: of all that is less than a cell from it on the cloth and does not touch it.
bool creased() {
  if (apart()) return false;
  precise real squared = collision[0].surface_reach_squared_m2 * 1.0009765625;
  real3 here = x_at(1, 1), right = x_at(2, 1), below = x_at(1, 2), end = x_at(2, 2);
  bool found = triangle_in_reach(here, right, below, end, squared) ||
               triangle_in_reach(end, here, right, below, squared);
  for (int k = 0; k < 8 && !found; ++k) {
    bool from_first = k < 4;
    ivec2 to = from_first ? 1 + kRing[kFromFirst[k]] : 2 + kRing[kFromLast[k - 4]];
    found = edge_in_reach(right, below, from_first ? here : end, to, squared);
  }
  return found;
}

// Of the cells whose first particles are in the patch: a bit for each that is folded, and kCreased.
uint bends(Cells c, OwnPatch own) {
  uint bits = 0u;
  [[dont_unroll]] for (uint k = 0u; k < 4u; ++k) {
    uvec2 cell = own.low + uvec2(k % 2u, k / 2u);
    if (any(greaterThanEqual(cell, own.last))) continue;
    look_around(c, own, cell);
    if (folded()) bits |= 1u << k;
    if (creased()) bits |= kCreased;
  }
  return bits;
}
