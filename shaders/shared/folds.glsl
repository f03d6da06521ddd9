// Where the cloth bends so much that it may come within reach of itself from one cell to the next:
// docs/float-form.md "Folds". The including pass declares `position` and includes cells.glsl, dot.glsl,
// surface.glsl and patches.glsl first. Loops are unrolled, so that `around` can lie in registers.

// The particles of a patch and two more on every side, row by row; beyond the cloth's ends its last again.
const int kAcross = 6;
real3 around[kAcross * kAcross];
uint column_of[kAcross];  // that is read for each column: on the cloth
// Whether the cloth has the column, and the row: 1 or 0. Where they are numbers nothing branches.
uint has_column[kAcross], has_row[kAcross];

// By column and row; the patch's first particle is (2, 2).
real3 x_at(int i, int j) { return around[j * kAcross + i]; }
bool is_there(int i, int j) { return (has_column[i] & has_row[j]) != 0u; }

void choose_columns(OwnPatch own) {
  [[unroll]] for (int i = 0; i < kAcross; ++i) {
    int column = int(own.low.x) + i - 2;
    column_of[i] = uint(clamp(column, 0, int(own.last.x)));
    has_column[i] = column >= 0 && column <= int(own.last.x) ? 1u : 0u;
  }
}

// Rows `from` to the last of the patch's surroundings.
void load_rows(Cells c, OwnPatch own, const int from) {
  [[unroll]] for (int j = from; j < kAcross; ++j) {
    uint first = (own.first_row + uint(clamp(int(own.low.y) + j - 2, 0, int(own.last.y)))) * c.nx;
    [[unroll]] for (int i = 0; i < kAcross; ++i)
      around[j * kAcross + i] = load_position(first + column_of[i]).xyz;
  }
  [[unroll]] for (int j = 0; j < kAcross; ++j) {
    int row = int(own.low.y) + j - 2;
    has_row[j] = row >= 0 && row <= int(own.last.y) ? 1u : 0u;
  }
}

// From a patch to the one below it: what both see stays in registers.
void look_around(Cells c, OwnPatch own, bool is_below) {
  if (!is_below) {
    load_rows(c, own, 0);
    return;
  }
  [[unroll]] for (int p = 0; p < (kAcross - 2) * kAcross; ++p) around[p] = around[p + 2 * kAcross];
  load_rows(c, own, kAcross - 2);
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

// 1 when a triangle with these edges takes every direction on the cloth to one that goes on by `least` a
// cell at least where the frame has it: the symmetric part of the map has no eigenvalue below that.
uint goes_along(Frame frame, real least, real3 edge_i, real3 edge_j) {
  precise real a = dot3(frame.along, edge_i) - least, b = dot3(frame.down, edge_j) - least;
  precise real m = 0.5 * (dot3(frame.along, edge_j) + dot3(frame.down, edge_i));
  precise real off = m * m, both = a * b;
  return uint(a >= 0.0) & uint(b >= 0.0) & uint(both >= off);
}

// Whether the cloth within a cell of the cell whose first particle is (i0, j0) bends so much that surfaces a
// cell apart on it may be in reach of each other. Where the cloth ends the block ends.
bool folded(const int i0, const int j0, real least) {
  real3 first = x_at(i0 - 1, j0 - 1), beyond = x_at(i0 + 2, j0 - 1);
  real3 under = x_at(i0 - 1, j0 + 2), last = x_at(i0 + 2, j0 + 2);
  precise real3 along = (beyond - first) + (last - under), down = (under - first) + (last - beyond);
  Frame frame = frame_of(along, down);
  uint found = 0u;
  [[unroll]] for (int n = 0; n < 9; ++n) {  // bounds that are known before anything is unrolled
      const int i = i0 - 1 + n % 3, j = j0 - 1 + n / 3;
      precise real3 top = x_at(i + 1, j) - x_at(i, j), side = x_at(i, j + 1) - x_at(i, j);
      precise real3 bottom = x_at(i + 1, j + 1) - x_at(i, j + 1), far = x_at(i + 1, j + 1) - x_at(i + 1, j);
      uint is_cell = has_column[i] & has_column[i + 1] & has_row[j] & has_row[j + 1];
      found |= is_cell & ~(goes_along(frame, least, top, side) & goes_along(frame, least, bottom, far));
    }
  return found != 0u;
}

// The ends of the edges that leave a cell's first particle, and its last, and do not touch the diagonal.
const uint kFromFirst[4] = uint[4](2u, 3u, 4u, 5u), kFromLast[4] = uint[4](0u, 1u, 2u, 5u);

// How far a place is along the way from the cell's first particle to its last, times the way's length.
real on_way(real3 way, real3 from, real3 x) {
  precise real3 d = x - from;
  return dot3(way, d);
}

// Whether three planes across that way, flat_min apart, part the cell's diagonal from what leaves the two.
bool apart(const int i0, const int j0, real least) {
  real3 here = x_at(i0, j0), end = x_at(i0 + 1, j0 + 1);
  precise real3 way = end - here;
  real right = on_way(way, here, x_at(i0 + 1, j0)), below = on_way(way, here, x_at(i0, j0 + 1));
  real before = 0.0, after = on_way(way, here, end);
  [[unroll]] for (int k = 0; k < 4; ++k) {
    ivec2 a = ivec2(i0, j0) + kRing[kFromFirst[k]], b = ivec2(i0, j0) + 1 + kRing[kFromLast[k]];
    before = is_there(a.x, a.y) ? max(before, on_way(way, here, x_at(a.x, a.y))) : before;
    after = is_there(b.x, b.y) ? min(after, on_way(way, here, x_at(b.x, b.y))) : after;
  }
  precise real room = least * sqrt(dot3(way, way));
  precise real ahead = min(right, below) - before, behind = after - max(right, below);
  return ahead > room && behind > room;
}

bool triangle_in_reach(real3 p, real3 a, real3 b, real3 corner, real squared) {
  real3 d = from_triangle(p, a, b, corner, closest_in_triangle(p, a, b, corner));
  return dot3(d, d) < squared;
}

bool edge_in_reach(real3 a, real3 b, real3 e, real3 f, real squared) {
  real s, t;
  closest_on_edges(a, b, e, f, s, t);
  real3 d = between_edges(a, b, e, f, s, t);
  return dot3(d, d) < squared;
}

// Whether the diagonal of the cell, or a triangle at it, may be in reach of the other corners or of the edges
// that leave them: of all that is less than a cell from it on the cloth and does not touch it. Cells whose
// planes do not part them are few, and places in a loop would not be registers: it reads memory.
bool diagonal_in_reach(Cells c, OwnPatch own, uvec2 cell) {
  precise real squared = collision[0].surface_reach_squared_m2 * 1.0009765625;
  uint first = (own.first_row + cell.y) * c.nx + cell.x;
  real3 here = load_position(first).xyz, right = load_position(first + 1u).xyz;
  real3 below = load_position(first + c.nx).xyz, end = load_position(first + c.nx + 1u).xyz;
  bool found = triangle_in_reach(here, right, below, end, squared) ||
               triangle_in_reach(end, here, right, below, squared);
  [[dont_unroll]] for (int k = 0; k < 8 && !found; ++k) {
    ivec2 to = ivec2(cell) + (k < 4 ? kRing[kFromFirst[k]] : 1 + kRing[kFromLast[k - 4]]);
    if (any(lessThan(to, ivec2(0))) || any(greaterThan(to, ivec2(own.last)))) continue;
    real3 f = load_position((own.first_row + uint(to.y)) * c.nx + uint(to.x)).xyz;
    found = edge_in_reach(right, below, k < 4 ? here : end, f, squared);
  }
  return found;
}

// Of the cells whose first particles are in the patch: a bit for each that is folded, and kCreased.
uint bends(Cells c, OwnPatch own) {
  real least = collision[0].flat_min_m;
  uint bits = 0u, close = 0u;  // cells that bend, and that the planes do not part
  [[unroll]] for (int k = 0; k < 4; ++k) {
    const int i = 2 + k % 2, j = 2 + k / 2;
    bool is_cell = (has_column[i + 1] & has_row[j + 1]) != 0u;
    bits |= is_cell && folded(i, j, least) ? 1u << k : 0u;
    close |= is_cell && !apart(i, j, least) ? 1u << k : 0u;
  }
  [[dont_unroll]] for (; close != 0u; close &= close - 1u) {
    uint k = uint(findLSB(close));
    if (diagonal_in_reach(c, own, own.low + uvec2(k % 2u, k / 2u))) bits |= kCreased;
  }
  return bits;
}
