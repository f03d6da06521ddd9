// What a thread keeps of the rows of particles while it looks at patches, and how near the particles of two
// patches beside each other come. Included by patch_text.h.

/// The rows round a row of patches. Each stands there twice: as it is, with its first and last particle again
/// beyond its ends; and split into even and odd columns, with no number where the cloth has no particle,
/// which is near nothing.
struct PatchScratch {
  PatchScratch(float* scratch, Index nx)
      : columns((nx + kColumns - 1) / kColumns * kColumns + 2 * kColumns),
        patches((nx / 2 + kColumns) / kColumns * kColumns + 2 * kColumns),
        rows_(scratch),
        bends_(reinterpret_cast<int*>(scratch + 18 * columns)),
        uneven_(bends_ + 2 * columns),
        split_(scratch + 38 * columns),
        near_(split_ + 24 * patches) {
    __builtin_memset(bends_, 0, 20 * columns * sizeof(int));
    fill(near_, near_ + 7 * patches, __builtin_inff());
  }

  Index columns, patches;  ///< how far the coordinates of a row are apart, and of a split one
  float* row(Index j) const { return rows_ + j % 6 * 3 * columns + kColumns; }
  int* bends(int row) const { return bends_ + row * columns; }  ///< of the cells of a patch's two rows
  /// Of row j, -1 where what an uneven_row says is too much.
  int* uneven(Index j, int which) const { return uneven_ + (j % 6 * 3 + which) * columns + kColumns; }
  /// Even columns; the odd ones.
  float* split(Index j, int odd) const { return split_ + (j % 4 * 2 + odd) * 3 * patches + kColumns; }
  /// By patch, the square of the distance to the nearest particle of the patch to the right; and of row y, of
  /// those below, below to the right and below to the left.
  float* to_right() const { return near_ + kColumns; }
  float* to_below(Index y, int which) const { return near_ + (1 + y % 2 * 3 + which) * patches + kColumns; }

 private:
  float* rows_;
  int *bends_, *uneven_;
  float *split_, *near_;
};

/// Row j of the cloth, both ways; one that the cloth does not have only split.
inline void take_row(const PatchScratch& s, const PatchLook& look, Index j) {
  const float none = __builtin_nanf("");
  float *const even = s.split(j, 0), *const odd = s.split(j, 1);
  if (j >= look.ny) {
    fill(even - kColumns, odd - kColumns + 3 * s.patches, none);
    return;
  }
  const Index nx = look.nx, even_count = (nx + 1) / 2, odd_count = nx / 2;
  for (int axis = 0; axis < 3; ++axis) {
    const float* const from = look.rows[j] + kColumns + axis * look.stride;
    float* const to = s.row(j) + axis * s.columns;
    fill(to - kColumns, to, from[0]);
    __builtin_memcpy(to, from, nx * sizeof(float));
    fill(to + nx, to - kColumns + s.columns, from[nx - 1]);
    float *const evens_to = even + axis * s.patches, *const odds_to = odd + axis * s.patches;
    for (Index k = 0; k < even_count; k += kLanes) {
      const Vec a = load(to + 2 * k), b = load(to + 2 * k + kLanes);
      store(evens_to + k, evens(a, b));
      store(odds_to + k, odds(a, b));
    }
    const auto none_beside = [&](float* side, Index count) {
      fill(side - kColumns, side, none);
      fill(side + count, side - kColumns + s.patches, none);
    };
    none_beside(evens_to, even_count);
    none_beside(odds_to, odd_count);
  }
}

/// A vector of patches, by row and column of their particles.
struct VecPatch {
  Vec3 x[2][2];
};
WEFT_INLINE VecPatch load_patch(const PatchScratch& s, Index y, Index k, int across) {
  VecPatch patch;
  for (int row = 0; row < 2; ++row)
    for (int odd = 0; odd < 2; ++odd)
      patch.x[row][odd] = load3(s.split(2 * y + row, odd) + k + across, s.patches);
  return patch;
}

/// The least square of the distances of two particles, one of each, that are not beside each other, of
/// patches so many to the right and down from each other; infinite without one.
template <int kRight, int kDown>
WEFT_INLINE Vec nearest_between(const VecPatch& a, const VecPatch& b) {
  Vec least = splat(__builtin_inff());
#pragma GCC unroll 4
  for (int p = 0; p < 4; ++p)
#pragma GCC unroll 4
    for (int q = 0; q < 4; ++q) {
      const int i = 2 * kRight + q % 2 - p % 2, j = 2 * kDown + q / 2 - p / 2;
      if (i >= -1 && i <= 1 && j >= -1 && j <= 1) continue;
      const Vec3 d = b.x[q / 2][q % 2] - a.x[p / 2][p % 2];
      least = smaller(dot(d, d), least);
    }
  return least;
}

/// How near the patches of row y are to those to the right, and to those of the next row.
WEFT_INLINE void look_between(const PatchScratch& s, Index y, Index count, bool has_below) {
  float *const below = s.to_below(y, 0), *const falling = s.to_below(y, 1), *const rising = s.to_below(y, 2);
  for (Index k = 0; k < count; k += kLanes) {
    const VecPatch own = load_patch(s, y, k, 0);
    store(s.to_right() + k, nearest_between<1, 0>(own, load_patch(s, y, k, 1)));
    const Vec far = splat(__builtin_inff());
    store(below + k, has_below ? nearest_between<0, 1>(own, load_patch(s, y + 1, k, 0)) : far);
    store(falling + k, has_below ? nearest_between<1, 1>(own, load_patch(s, y + 1, k, 1)) : far);
    store(rising + k, has_below ? nearest_between<-1, 1>(own, load_patch(s, y + 1, k, -1)) : far);
  }
}

/// The least square of the distance of a patch's particles to others of it and those beside it that are not
/// beside them.
WEFT_INLINE Vec nearest_beside(const PatchScratch& s, Index y, Index k) {
  Vec least = smaller(load(s.to_right() + k), load(s.to_right() + k - 1));
  const auto take = [&](const float* from) { least = smaller(load(from), least); };
  for (int which = 0; which < 3; ++which) take(s.to_below(y, which) + k);
  if (y == 0) return least;
  take(s.to_below(y - 1, 0) + k);
  take(s.to_below(y - 1, 1) + k - 1);
  take(s.to_below(y - 1, 2) + k + 1);
  return least;
}
