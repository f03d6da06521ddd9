// Whether a cloth is spread out over a plane, a vector of cells of a row at a time, as docs/float-form.md
// "Spread". Included by kernel_text.h.

/// A row of edges in a plane: how far they go along its first axis and along its second.
struct InPlane {
  Vec first, second;
};

/// Whether a triangle with these edges along and down goes less than `least` along the plane.
WEFT_INLINE Mask is_short(InPlane along, InPlane down, Vec least) {
  return goes_against({along.first - least, along.second}, {down.second - least, down.first});
}

/// Of a vector of cells, the four rows of particles round them; where the cloth ends its last stand again.
struct CellSurroundings {
  CellSurroundings(const SpreadLook& look, Index j, Index i) {
    const Index above = j > 0 ? j - 1 : 0, below = j + 2 < look.ny ? j + 2 : look.ny - 1;
    const Index rows_of[4] = {above, j, j + 1, below};
    for (int row = 0; row < 4; ++row)
      for (int axis = 0; axis < 3; ++axis)
        for (Index k = 0; k < kWide; ++k) {
          const Index right = i + k < 1 ? 0 : i + k - 1;
          const float* const from = look.rows[rows_of[row]] + kColumns + axis * look.stride;
          at[row][axis][k] = from[right < look.nx ? right : look.nx - 1];
        }
    cells = {{at[0][0] + 1, at[1][0] + 1, at[2][0] + 1, at[3][0] + 1}, kWide, j > 0, j + 2 < look.ny};
  }
  static constexpr Index kWide = kLanes + 3;
  float at[4][3][kWide];
  CellRows cells;
};

/// Whether cells of which some are too short in the common plane are spread in that of their surroundings.
__attribute__((noinline)) bool is_spread_locally(const SpreadLook& look, Index j, Index i, Mask asked) {
  const CellSurroundings round(look, j, i);
  return !any(asked & folded(round.cells, 0, cell_masks(i, look.nx), splat(look.local_min)));
}

void look_how_spread(SpreadLook& look) {
  const Vec3 axis1 = splat3(look.along), axis2 = splat3(look.down);
  const Vec3 shared_speed = splat3(look.shared_speed);
  const Vec spread_min = splat(look.spread_min), local_min = splat(look.local_min);
  const Index stride = look.stride;
  const auto in_plane = [&](Vec3 edge) { return InPlane{dot(edge, axis1), dot(edge, axis2)}; };
  Mask unsound{};
  Vec most_apart{}, most_speed{}, most_place{}, longest{};
  for (Index j = look.first; j < look.last; ++j) {
    const float* const row = look.rows[j] + kColumns;
    const bool has_below = j + 1 < look.ny;
    const float* const next = has_below ? look.rows[j + 1] + kColumns : row;
    for (Index i = 0; i < look.nx; i += kLanes) {
      const Mask column = lanes_from(static_cast<int>(i)), own = column < static_cast<int>(look.nx),
                 cell = column + 1 < static_cast<int>(look.nx);
      const Vec3 x = load3(row + i, stride), right = load3(row + i + 1, stride),
                 under = load3(next + i, stride), far = load3(next + i + 1, stride);
      const Vec3 along = right - x, down = under - x;
      const Vec3 v = load3(row + i + 3 * stride, stride),
                 along_v = load3(row + i + 3 * stride + 1, stride) - v,
                 down_v = load3(next + i + 3 * stride, stride) - v, own_v = v - shared_speed;
      const Vec place2 = select(own, dot(x, x), Vec{}), speed2 = select(own, dot(own_v, own_v), Vec{}),
                along2 = select(cell, dot(along_v, along_v), Vec{}),
                down2 = select(own, dot(down_v, down_v), Vec{});
      const Vec edge2 = larger(select(cell, dot(along, along), Vec{}), select(own, dot(down, down), Vec{}));
      unsound = unsound | ~((place2 + speed2) + (along2 + down2) < __builtin_inff());
      most_place = larger(place2, most_place);
      most_speed = larger(speed2, most_speed);
      longest = larger(edge2, longest);
      most_apart = larger(larger(along2, down2), most_apart);
      if (!has_below) continue;
      const InPlane top = in_plane(along), bottom = in_plane(far - under), down_left = in_plane(down),
                    down_right = in_plane(far - right);
      const auto is_short_by = [&](Vec least) {
        return cell & (is_short(top, down_left, least) | is_short(bottom, down_right, least));
      };
      const Mask asked = is_short_by(local_min);
      if (__builtin_expect(!any(asked), true)) continue;
      if (any(is_short_by(spread_min)) || !is_spread_locally(look, j, i, asked)) unsound = ~Mask{};
    }
    if (any(unsound)) break;
  }
  look.unsound = any(unsound) ? 1 : 0;
  look.apart2 = largest(most_apart);
  look.speed2 = largest(most_speed);
  look.place2 = largest(most_place);
  look.longest2 = largest(longest);
}
