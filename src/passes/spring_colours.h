// Colours of springs: those of a colour share no particle, so that they may be pulled in any order or at
// once. docs/solvers.md "xpbd".
#pragma once
#include <cstdint>

#include "model/model.h"
#include "passes/pass.h"

namespace weft {

/// An item of a pass over coloured springs: two colours for each of the six kinds.
struct SpringColour {
  SpringName kind;
  std::uint32_t colour;
  static SpringColour of(std::uint32_t item) { return {static_cast<SpringName>(item / 2), item % 2}; }
  bool has(std::uint32_t i, std::uint32_t j) const {
    switch (kind) {
      case kStructuralJ: return j % 2 == colour;
      case kFlexI: return i / 2 % 2 == colour;
      case kFlexJ: return j / 2 % 2 == colour;
      default: return i % 2 == colour;  // (1,0) and both diagonals: chains that advance in i
    }
  }
};
inline constexpr std::uint32_t kSpringColours = 2 * kSpringKindCount;
inline constexpr std::uint32_t kNearSpringColours = 8;  ///< structural and shear: the first of them

/// A spring named by (i, j) of its cloth, and its two ends.
struct ColouredSpring {
  std::uint32_t i, j, a, b;
};

/// Calls visit(spring) for each spring of the colour that begins in rows [begin, end) of all. The rising
/// diagonal is named by its left particle's column, as f_T in docs/float-form.md.
template <class Visit>
void for_each_spring_of(const Grid& grid, const SpringColour& springs, std::uint32_t begin, std::uint32_t end,
                        Visit&& visit) {
  static constexpr std::uint32_t kReachI[] = {1, 0, 1, 1, 2, 0}, kReachJ[] = {0, 1, 1, 1, 0, 2};
  const std::uint32_t di = kReachI[springs.kind], dj = kReachJ[springs.kind];
  for (std::uint32_t row = begin; row < end; ++row) {
    const std::uint32_t j = grid.own_row(row);
    if (j + dj >= grid.ny) continue;
    for (std::uint32_t i = 0; i + di < grid.nx; ++i) {
      if (!springs.has(i, j)) continue;
      const bool rising = springs.kind == kShearUp;
      visit(ColouredSpring{i, j, rising ? grid.index(i + 1, row) : grid.index(i, row),
                           rising ? grid.index(i, row + 1) : grid.index(i + di, row + dj)});
    }
  }
}

/// Where an item runs; empty where the cloth has no springs of its kind. Two colours of a kind share the
/// lanes of the longer one; lanes beyond the last spring return at once.
inline Range spring_colour_range(const Model& m, std::uint32_t item) {
  const SpringColour springs = SpringColour::of(item);
  if (m.springs[springs.kind].stiffness_n_m <= 0.0) return {};
  const std::uint32_t nx = m.grid.nx, ny = m.grid.ny, rows = m.grid.rows(), cloths = m.grid.cloths;
  const auto halves = [](std::uint32_t count) { return (count + 1) / 2; };
  const auto pairs_of_two = [](std::uint32_t count) { return (count + 3) / 4 * 2; };
  switch (springs.kind) {
    case kStructuralI: return {.x = halves(nx), .y = rows};
    case kStructuralJ: return {.x = nx, .y = cloths * halves(ny)};
    case kFlexI: return {.x = pairs_of_two(nx), .y = rows};
    case kFlexJ: return {.x = nx, .y = cloths * pairs_of_two(ny)};
    default: return {.x = halves(nx), .y = rows};
  }
}

}  // namespace weft
