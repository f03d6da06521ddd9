// Which patches have others near that are not beside them, as docs/float-form.md "Patches": a tree of boxes,
// sixteen to a node, each looked through for the sixteen patches of a leaf. Included by kernel_text.h.

/// Sixteen boxes that are near nothing.
WEFT_INLINE void clear(NearNode& node) {
  for (int axis = 0; axis < 3; ++axis) {
    fill(node.low[axis], node.low[axis] + kColumns, __builtin_inff());
    fill(node.high[axis], node.high[axis] + kColumns, -__builtin_inff());
  }
}

/// The box of a node's sixteen, into a lane of another's.
WEFT_INLINE void join(const NearNode& from, NearNode& to, int lane) {
  for (int axis = 0; axis < 3; ++axis) {
    float low = from.low[axis][0], high = from.high[axis][0];
    for (Index k = 1; k < kColumns; ++k) {
      low = from.low[axis][k] < low ? from.low[axis][k] : low;
      high = from.high[axis][k] > high ? from.high[axis][k] : high;
    }
    to.low[axis][lane] = low;
    to.high[axis][lane] = high;
  }
}

/// The first row of patches of a row of leaves, within its cloth; and how many the cloths before it have.
WEFT_INLINE Index row_of_leaf(const NearLook& look, Index y) { return 4 * (y % look.leaf_rows); }
WEFT_INLINE Index rows_before_leaf(const NearLook& look, Index y) { return y / look.leaf_rows * look.ny; }
/// The k-th patch of leaf (x, y).
WEFT_INLINE Index patch_of_leaf(const NearLook& look, Index x, Index y, Index k) {
  return (rows_before_leaf(look, y) + row_of_leaf(look, y) + k / 4) * look.nx + 4 * x + k % 4;
}

/// Leaves of rows [first, last) from their patches' boxes; one that the grid does not cover is near nothing.
void make_near_leaves(const NearLook& look) {
  const NearLevel& level = look.levels[0];
  for (Index y = look.first; y < look.last; ++y)
    for (Index x = 0; x < level.across; ++x) {
      NearNode& leaf = level.nodes[y * level.across + x];
      clear(leaf);
      for (Index k = 0; k < kColumns; ++k) {
        if (4 * x + k % 4 >= look.nx || row_of_leaf(look, y) + k / 4 >= look.ny) continue;
        const float* const box = look.boxes + 8 * patch_of_leaf(look, x, y, k);
        bool inside = true;
        for (int end = 0; end < 6; ++end) {
          const float at = box[end / 3 * 4 + end % 3] * look.inverse_cell;
          inside = inside && at < look.cells_most && at > -look.cells_most;
        }
        for (int axis = 0; inside && axis < 3; ++axis) {
          leaf.low[axis][k] = box[axis];
          leaf.high[axis][k] = box[4 + axis];
        }
      }
    }
}

/// The levels above the leaves.
void make_near_levels(const NearLook& look) {
  for (Index n = 1; n < look.level_count; ++n) {
    const NearLevel &level = look.levels[n], &below = look.levels[n - 1];
    for (Index y = 0; y < level.down; ++y)
      for (Index x = 0; x < level.across; ++x) {
        NearNode& node = level.nodes[y * level.across + x];
        clear(node);
        for (int k = 0; k < 16; ++k) {
          const Index i = 4 * x + k % 4, j = 4 * y + k / 4;
          if (i < below.across && j < below.down) join(below.nodes[j * below.across + i], node, k);
        }
      }
  }
}

/// The patches of a leaf, a bit for each.
struct NearLeaf {
  Index x, y;
  unsigned open = 0;  ///< of those that it is not known of yet
  unsigned far = 0;   ///< that have others near
  float low[3], high[3];
};

/// What boxes alone say: one that is wider than so many cells of the grid is taken to have others near, as
/// is one whose particles have.
WEFT_INLINE NearLeaf open_leaf(const NearLook& look, Index x, Index y) {
  const NearNode& own = look.levels[0].nodes[y * look.levels[0].across + x];
  NearLeaf leaf{x, y};
  const Vec inverse = splat(look.inverse_cell), around = splat(look.far_cells);
  for (Index base = 0; base < kColumns; base += kLanes) {
    const Mask inside = load(own.low[0] + base) <= load(own.high[0] + base);
    Mask wide{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto cells = [&](const float* at) { return select(inside, load(at + base) * inverse, Vec{}); };
      wide = wide | (floored(cells(own.high[axis]) + around) >
                     floored(cells(own.low[axis]) - around) + (look.cells_across - 1));
    }
    leaf.open |= bits_of(inside) << base;
    leaf.far |= bits_of(wide & inside) << base;
  }
  for (Index k = 0; k < kColumns; ++k) {
    if ((leaf.open >> k & 1u) != 0 &&
        (look.overlooks || look.boxes[8 * patch_of_leaf(look, x, y, k) + 3] == 0.0f))
      leaf.far |= 1u << k;
  }
  leaf.open &= ~leaf.far;
  NearNode joined;
  join(own, joined, 0);
  for (int axis = 0; axis < 3; ++axis) {
    leaf.low[axis] = joined.low[axis][0];
    leaf.high[axis] = joined.high[axis][0];
  }
  return leaf;
}

/// A box where its corners lie.
struct BoxAt {
  const float *low[3], *high[3];
};
WEFT_INLINE BoxAt box_in(const NearNode& node, Index k) {
  return {{node.low[0] + k, node.low[1] + k, node.low[2] + k},
          {node.high[0] + k, node.high[1] + k, node.high[2] + k}};
}

/// Of sixteen boxes, those less than the distance away from one along every axis.
WEFT_INLINE unsigned near_boxes(const NearNode& node, const BoxAt& box, Vec distance) {
  unsigned found = 0;
  for (Index base = 0; base < kColumns; base += kLanes) {
    Vec gap = splat(-__builtin_inff());
    for (int axis = 0; axis < 3; ++axis)
      gap = larger(larger(load(node.low[axis] + base) - splat(*box.high[axis]),
                          splat(*box.low[axis]) - load(node.high[axis] + base)),
                   gap);
    found |= bits_of(gap < distance) << base;
  }
  return found;
}

/// Of the sixteen patches of leaf (x, y), those that are (i, j) or beside it.
WEFT_INLINE unsigned beside_in(Index x, Index y, Index i, Index j) {
  const auto near = [](Index first, Index at) {  // of four, those from at − 1 to at + 1
    const Index place = at + 1 - first;
    return place > 5 ? 0u : (7u << place >> 2) & 15u;
  };
  const unsigned columns = near(4 * x, i), rows = near(4 * y, j);
  return (columns * 0x1111u) &
         ((rows & 1u) * 0xfu | (rows & 2u) * 0x78u | (rows & 4u) * 0x3c0u | (rows & 8u) * 0x1e00u);
}

/// The open patches of a leaf against those of leaf (x, y): first against the box of them all.
WEFT_INLINE void look_at_leaf(const NearLook& look, NearLeaf& leaf, Index x, Index y, const BoxAt& all) {
  const NearLevel& level = look.levels[0];
  const NearNode &own = level.nodes[leaf.y * level.across + leaf.x],
                 &other = level.nodes[y * level.across + x];
  const bool adjacent = x + 1 >= leaf.x && x <= leaf.x + 1 && y + 1 >= leaf.y && y <= leaf.y + 1 &&
                        y / look.leaf_rows == leaf.y / look.leaf_rows;
  const Vec distance = splat(look.distance);
  for (unsigned open = leaf.open & near_boxes(own, all, distance); open != 0; open &= open - 1) {
    const auto k = static_cast<Index>(__builtin_ctz(open));
    unsigned found = near_boxes(other, box_in(own, k), distance);
    if (found != 0 && adjacent) found &= ~beside_in(x, y, 4 * leaf.x + k % 4, 4 * leaf.y + k / 4);
    if (found != 0) leaf.far |= 1u << k;
  }
  leaf.open &= ~leaf.far;
}

/// All leaves against one, but those that no box of the tree brings near.
WEFT_INLINE void search_leaf(const NearLook& look, NearLeaf& leaf) {
  struct Place {
    Index level, x, y;
  };
  const BoxAt own{{leaf.low, leaf.low + 1, leaf.low + 2}, {leaf.high, leaf.high + 1, leaf.high + 2}};
  if (look.level_count == 1) return look_at_leaf(look, leaf, 0, 0, own);
  Place waiting[kColumns * kNearLevels];
  Index count = 0;
  waiting[count++] = {look.level_count - 1, 0, 0};
  while (count > 0 && leaf.open != 0) {
    const Place at = waiting[--count];
    const NearLevel& level = look.levels[at.level];
    const NearNode& node = level.nodes[at.y * level.across + at.x];
    for (unsigned found = near_boxes(node, own, splat(look.distance)); found != 0; found &= found - 1) {
      const auto k = static_cast<Index>(__builtin_ctz(found));
      const Index x = 4 * at.x + k % 4, y = 4 * at.y + k / 4;
      if (at.level == 1)
        look_at_leaf(look, leaf, x, y, box_in(node, k));
      else
        waiting[count++] = {at.level - 1, x, y};
    }
  }
}

void look_near(const NearLook& look) {
  for (Index y = look.first; y < look.last; ++y)
    for (Index x = 0; x < look.levels[0].across; ++x) {
      NearLeaf leaf = open_leaf(look, x, y);
      search_leaf(look, leaf);
      for (unsigned far = leaf.far; far != 0; far &= far - 1) {
        const auto k = static_cast<Index>(__builtin_ctz(far));
        look.listed[patch_of_leaf(look, x, y, k)] |= look.looks_far;
      }
    }
}
