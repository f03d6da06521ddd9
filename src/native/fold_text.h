// Which cells bend, a vector of cells of a row at a time, as docs/float-form.md "Folds". Included by
// kernel_text.h.

constexpr float kHalfRoot = 0.70710678f;  // as shared/collision.h

/// The four rows of particles round a row of cells, from the one above on; where the cloth ends the last
/// stands again, and so the last column does beyond either end.
struct CellRows {
  const float* rows[4];
  Index stride;
  bool has_above, has_below;  ///< whether there are cells above and below
  /// The particle `column` columns from the cells' first, in row `row`.
  WEFT_INLINE Vec3 at(int row, Index i, int column) const { return load3(rows[row] + i + column, stride); }
};

/// Of a vector of cells: which exist, and whether those to either side do.
struct CellMasks {
  Mask own, left, right;
};
WEFT_INLINE CellMasks cell_masks(Index i, Index nx) {
  const Mask column = lanes_from(static_cast<int>(i));
  const int count = static_cast<int>(nx);
  return {column + 1 < count, column > 0, column + 2 < count};
}

struct VecFrame {
  Vec3 along, down;
};
WEFT_INLINE VecFrame frame_of(Vec3 along, Vec3 down) {
  const Vec one = splat(1.0f), half_root = splat(kHalfRoot);
  const Vec3 a = (one / root(dot(along, along))) * along, b = (one / root(dot(down, down))) * down;
  const Vec3 sum = a + b, rest = a - b;
  const Vec3 u = (half_root / root(dot(sum, sum))) * sum, w = (half_root / root(dot(rest, rest))) * rest;
  return {u + w, u - w};
}

/// An edge along (or down) as a frame has it: how much further than flat_min it goes its own way, and how far
/// the other.
struct EdgeInFrame {
  Vec own, other;
};

/// Whether a triangle with these edges goes against the frame.
WEFT_INLINE Mask goes_against(EdgeInFrame along, EdgeInFrame down) {
  const Vec mixed = splat(0.5f) * (down.other + along.other), none{};
  return ~((along.own >= none) & (down.own >= none) & (along.own * down.own >= mixed * mixed));
}

/// Which cells are folded.
WEFT_INLINE Mask folded(const CellRows& cells, Index i, const CellMasks& masks, Vec flat_min) {
  const Vec3 first = cells.at(0, i, -1), beyond = cells.at(0, i, 2), under = cells.at(3, i, -1),
             last = cells.at(3, i, 2);
  const VecFrame frame = frame_of((beyond - first) + (last - under), (under - first) + (last - beyond));
  const auto edges_along = [&](const Vec3(&p)[4], EdgeInFrame(&to)[3]) {
    for (int c = 0; c < 3; ++c) {
      const Vec3 e = p[c + 1] - p[c];
      to[c] = {dot(frame.along, e) - flat_min, dot(frame.down, e)};
    }
  };
  const auto particles = [&](int row, Vec3(&to)[4]) {
    for (int c = 0; c < 4; ++c) to[c] = cells.at(row, i, c - 1);
  };
  const int begin = cells.has_above ? 0 : 1, end = cells.has_below ? 3 : 2;
  Vec3 upper[4], lower[4];
  EdgeInFrame above[3], below[3], down[4];
  Mask against[3]{};
  particles(begin, upper);
  edges_along(upper, above);
  for (int row = begin; row < end; ++row) {
    particles(row + 1, lower);
    edges_along(lower, below);
    for (int c = 0; c < 4; ++c) {
      const Vec3 e = lower[c] - upper[c];
      down[c] = {dot(frame.down, e) - flat_min, dot(frame.along, e)};
      upper[c] = lower[c];
    }
    for (int c = 0; c < 3; ++c) {
      against[c] = against[c] | goes_against(above[c], down[c]) | goes_against(below[c], down[c + 1]);
      above[c] = below[c];
    }
  }
  return masks.own & ((against[0] & masks.left) | against[1] | (against[2] & masks.right));
}

/// Of which cells no three planes part the diagonal from what leaves its ends.
WEFT_INLINE Mask not_apart(const CellRows& cells, Index i, const CellMasks& masks, Vec flat_min) {
  const Vec3 here = cells.at(1, i, 0), end = cells.at(2, i, 1), way = end - here;
  const auto on = [&](int row, int column) { return dot(way, cells.at(row, i, column) - here); };
  const Vec right = on(1, 1), below = on(2, 0);
  Vec before{}, after = on(2, 1);
  const auto precedes = [&](Vec y, Mask there) { before = select(there, larger(y, before), before); };
  const auto follows = [&](Vec y, Mask there) { after = select(there, smaller(y, after), after); };
  precedes(on(2, -1), masks.left);
  precedes(on(1, -1), masks.left);
  if (cells.has_above) {
    precedes(on(0, 0), masks.own);
    precedes(on(0, 1), masks.own);
  }
  follows(on(2, 2), masks.right);
  if (cells.has_below) {
    follows(on(3, 1), masks.own);
    follows(on(3, 0), masks.own);
  }
  follows(on(1, 2), masks.right);
  const Vec room = flat_min * root(dot(way, way));
  return masks.own & ~((smaller(below, right) - before > room) & (after - larger(below, right) > room));
}
