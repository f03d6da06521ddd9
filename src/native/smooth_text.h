// Which cells lie amid edges so even that no test of folds and creases can find anything: docs/float-form.md
// "Folds", "Smooth". Included by kernel_text.h.

/// What two edges that follow each other differ by: along a row, from one row to the next, down a column.
enum Uneven { kAlong, kAcross, kDown };

/// Of row j, and of the one above what needs row j: where edges differ by too much.
WEFT_INLINE void look_how_even(const PatchScratch& s, const PatchLook& look, Index j) {
  const Vec most = splat(look.smooth.bend2);
  const Index stride = s.columns, nx = look.nx;
  const auto differ = [&](Vec3 a, Vec3 b) {
    const Vec3 d = a - b;
    return ~(dot(d, d) <= most);
  };
  const auto put = [](int* to, Mask rough, Mask there) { store_ints(to, rough & there); };
  const float *const row = s.row(j), *const above = s.row(j + 5), *const top = s.row(j + 4);  // of six
  for (Index i = 0; i < nx; i += kLanes) {
    const Mask column = lanes_from(static_cast<int>(i)), has_right = column + 1 < static_cast<int>(nx);
    const Vec3 here = load3(row + i, stride), right = load3(row + i + 1, stride);
    put(s.uneven(j, kAlong) + i, differ(right - here, here - load3(row + i - 1, stride)),
        has_right & (column > 0));
    if (j == 0) continue;
    const Vec3 up = load3(above + i, stride);
    put(s.uneven(j - 1, kAcross) + i, differ(right - here, load3(above + i + 1, stride) - up), has_right);
    if (j == 1) continue;
    put(s.uneven(j - 1, kDown) + i, differ(here - up, up - load3(top + i, stride)),
        column < static_cast<int>(nx));
  }
}

/// Whether the edges of the 3 x 3 cells round a vector of cells of row j differ little from its own.
WEFT_INLINE Mask is_even_round(const PatchScratch& s, Index j, Index i, bool has_above, bool has_below) {
  Mask rough{};
  const auto ask = [&](Index row, Uneven which, int column) {
    Mask there;
    __builtin_memcpy(&there, s.uneven(row, which) + i + column, sizeof there);
    rough = rough | there;
  };
  for (Index row = has_above ? j - 1 : j; row <= (has_below ? j + 2 : j + 1); ++row) {
    ask(row, kAlong, 0);
    ask(row, kAlong, 1);
  }
  for (Index row = has_above ? j - 1 : j; row <= (has_below ? j + 1 : j); ++row)
    for (int column = -1; column <= 1; ++column) ask(row, kAcross, column);
  if (has_above) ask(j, kDown, 0);
  if (has_below) ask(j + 1, kDown, 0);
  return ~rough;
}

/// Whether a cell with these edges is nearly a square, as far as that matters.
WEFT_INLINE Mask is_upright(const Smooth& smooth, Vec3 along, Vec3 down) {
  const Vec a = dot(along, along), c = dot(down, down), b = dot(along, down), none{};
  const Vec way2 = splat(smooth.apart2) * ((a + c) + (b + b));
  const auto passes = [&](Vec by) { return (by > none) & (by * by >= way2); };
  const Vec shear = splat(smooth.shear), length2 = splat(smooth.length2);
  return (a >= length2) & (c >= length2) & (b <= shear) & (b >= -shear) & passes((a + a) + b - c) &
         passes((c + c) + b - a) & passes(a + b) & passes(c + b);
}

/// Of a vector of cells, those that no test can find folded or creased.
WEFT_INLINE Mask is_smooth(const PatchScratch& s, const PatchLook& look, Index j, Index i) {
  const float *const row = s.row(j) + i, *const below = s.row(j + 1) + i;
  const Vec3 here = load3(row, s.columns);
  return is_upright(look.smooth, load3(row + 1, s.columns) - here, load3(below, s.columns) - here) &
         is_even_round(s, j, i, j > 0, j + 2 < look.ny);
}
