// Patches of 2 x 2 particles, a vector of them at a time, as docs/float-form.md "Patches": their boxes
// and which have particles close to each other. Included by kernel_text.h.
#include "native/split_text.h"

typedef unsigned Bits __attribute__((vector_size(4 * WEFT_LANES)));

WEFT_INLINE void store_ints(int* to, Mask v) { __builtin_memcpy(to, &v, sizeof v); }

/// Compared as bits: what is no number counts as more than any.
WEFT_INLINE void raise(Bits& most, Vec to, Mask where) {
  const Bits bits = (Bits)to & (Bits)where;
  most = bits > most ? bits : most;
}
WEFT_INLINE std::uint32_t largest(Bits most) {
  std::uint32_t all = 0;
  for (int lane = 0; lane < kLanes; ++lane)
    if (most[lane] > all) all = most[lane];
  return all;
}

/// Edges of row j to the right, below, and below to the left.
WEFT_INLINE void look_at_edges(const PatchScratch& s, Index j, Index nx, Index ny, Bits& longest) {
  const auto square = [](Vec3 a, Vec3 b) {
    const Vec3 d = b - a;
    return dot(d, d);
  };
  const float *const row = s.row(j), *const next = s.row(j + 1);
  const Index stride = s.columns;
  for (Index i = 0; i < nx; i += kLanes) {
    const Mask column = lanes_from(static_cast<int>(i)), own = column < static_cast<int>(nx);
    const Vec3 here = load3(row + i, stride);
    raise(longest, square(here, load3(row + i + 1, stride)), column + 1 < static_cast<int>(nx));
    if (j + 1 >= ny) continue;
    raise(longest, square(here, load3(next + i, stride)), own);
    raise(longest, square(here, load3(next + i - 1, stride)), own & (column > 0));
  }
}

#include "native/smooth_text.h"

/// Bits 1 for folded cells of row j, and 2 for those whose creases are to be looked at more closely.
WEFT_INLINE void look_at_cells(const PatchScratch& s, const PatchLook& look, Index j, int* bends) {
  if (j + 1 >= look.ny) {
    for (Index i = 0; i < look.nx; i += kLanes) store_ints(bends + i, Mask{});
    return;
  }
  const Vec flat_min = splat(look.flat_min);
  const Index below = j + 2 < look.ny ? j + 2 : j + 1;
  const CellRows cells{
      {s.row(j > 0 ? j - 1 : 0), s.row(j), s.row(j + 1), s.row(below)}, s.columns, j > 0, j + 2 < look.ny};
  for (Index i = 0; i < look.nx; i += kLanes) {
    const CellMasks masks = cell_masks(i, look.nx);
    if (!any(masks.own & ~is_smooth(s, look, j, i))) {
      store_ints(bends + i, Mask{});
      continue;
    }
    store_ints(bends + i,
               (folded(cells, i, masks, flat_min) & 1) | (not_apart(cells, i, masks, flat_min) & 2));
  }
}

/// Low and high corner of a vector of patches; what the cloth does not have is no number and leaves them.
struct VecBox {
  Vec3 low, high;
};
WEFT_INLINE void widen(VecBox& box, Vec3 x) {
  box.low = {smaller(x.x, box.low.x), smaller(x.y, box.low.y), smaller(x.z, box.low.z)};
  box.high = {larger(x.x, box.high.x), larger(x.y, box.high.y), larger(x.z, box.high.z)};
}

/// A bit for each of a patch's cells that has `bit` in what look_at_cells says.
WEFT_INLINE Mask cells_with(const PatchScratch& s, Index k, int bit) {
  Mask cells{};
  for (int row = 0; row < 2; ++row) {
    const int* const from = s.bends(row) + 2 * k;
    const Vec a = load(reinterpret_cast<const float*>(from)),
              b = load(reinterpret_cast<const float*>(from + kLanes));
    const auto placed = [&](Vec bends, int cell) { return (((Mask)bends & bit) != 0) & (1 << cell); };
    cells = cells | placed(evens(a, b), 2 * row) | placed(odds(a, b), 2 * row + 1);
  }
  return cells;
}

/// Two vec4s a patch: the corners, each with a number.
WEFT_INLINE void write_boxes(float* to, Index count, const VecBox& box, Vec low_w, Vec high_w) {
  const Vec parts[8] = {box.low.x, box.low.y, box.low.z, low_w, box.high.x, box.high.y, box.high.z, high_w};
  float lanes[8][kLanes];
  for (int part = 0; part < 8; ++part) store(lanes[part], parts[part]);
  for (Index lane = 0; lane < count; ++lane)
    for (int part = 0; part < 8; ++part) to[8 * lane + part] = lanes[part][lane];
}

/// Patches of row y from the k-th on; returns how many cells were left over up to here.
WEFT_INLINE Index look_at_vector(const PatchScratch& s, const PatchLook& look, Index y, Index k,
                                 Index left_over) {
  const Index per_row = (look.nx + 1) / 2, first = y * per_row + k;
  const Index count = per_row - k < kLanes ? per_row - k : kLanes;
  const VecPatch patch = load_patch(s, y, k, 0);
  VecBox box{patch.x[0][0], patch.x[0][0]};
  for (int p = 1; p < 4; ++p) widen(box, patch.x[p / 2][p % 2]);
  const Vec flat = select(nearest_beside(s, y, k) < splat(look.search_squared), splat(0.0f), splat(1.0f));
  const Vec folds = __builtin_convertvector(cells_with(s, k, 1), Vec);
  write_boxes(look.boxes + 8 * first, count, box, flat, folds);
  const Mask creased = cells_with(s, k, 2);
  if (!any(creased != Mask{})) return left_over;
  for (Index lane = 0; lane < count; ++lane)
    for (int cell = 0; cell < 4; ++cell)
      if ((creased[lane] >> cell & 1) != 0)
        look.left_over[left_over++] = static_cast<std::uint32_t>(4 * (first + lane) + cell);
  return left_over;
}

std::size_t look_at_patches(PatchLook& look) {
  const PatchScratch s(look.scratch, look.nx);
  const Index per_row = (look.nx + 1) / 2, patch_rows = (look.ny + 1) / 2;
  Bits longest{};
  Index left_over = 0, taken = look.first > 0 ? 2 * look.first - 2 : 0;
  const auto take_to = [&](Index end) {
    for (; taken < end; ++taken) {
      take_row(s, look, taken);
      if (taken < look.ny) look_how_even(s, look, taken);
    }
  };
  if (look.first > 0) {
    take_to(2 * look.first + 2);
    look_between(s, look.first - 1, per_row, true);
  }
  for (Index y = look.first; y < look.last; ++y) {
    take_to(2 * y + 4);
    look_between(s, y, per_row, y + 1 < patch_rows);
    for (int row = 0; row < 2; ++row) {
      const Index j = 2 * y + row;
      if (j < look.ny) look_at_edges(s, j, look.nx, look.ny, longest);
      look_at_cells(s, look, j, s.bends(row));
    }
    for (Index k = 0; k < per_row; k += kLanes) left_over = look_at_vector(s, look, y, k, left_over);
  }
  look.longest = largest(longest);
  return left_over;
}
