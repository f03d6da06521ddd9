// How far the searches for what is near look, and in which cells. The including pass includes cells.glsl and
// declares collision_state first.

// Squared: of two surfaces within reach, some two corners are no farther apart.
real surface_search_squared() {
  real longest = real(uintBitsToFloat(collision_state[kLongestEdge]));
  precise real search = (collision[0].surface_reach_squared_m2 + 0.5 * longest) * 1.0009765625;
  return search;
}

// Of particles that some list may have.
real search_distance() {
  precise real search = max(sqrt(surface_search_squared()), collision[0].pair_reach_m) * 1.0009765625;
  return search;
}

struct CellRange {
  ivec3 first, last;
  bool whole;  // not more cells than are looked at
};

// The cells in which the middles of blocks are that have a particle within `search` of the box.
CellRange cells_around(Cells c, real3 low, real3 high, real search) {
  precise real far = search + 0.5009765625 * real(uintBitsToFloat(collision_state[kWidestBlock]));
  precise real far_cells = min(far * c.inverse_cell_1_m, real(kCellsFromOriginMax));
  precise real3 low_cells = low * c.inverse_cell_1_m, high_cells = high * c.inverse_cell_1_m;
  precise real3 first = floor(low_cells - far_cells), last = floor(high_cells + far_cells);
  real3 cut = min(last, first + real(kCellsAcrossMax - 1));
  return CellRange(ivec3(first), ivec3(cut), cut == last);
}
