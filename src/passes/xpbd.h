// What the XPBD passes share on the CPU: coefficients of each kind of constraint, and the colours by which
// constraints of a colour share no particle. docs/solvers.md "xpbd".
#pragma once
#include <array>

#include "passes/substep.h"
#include "shared/params.h"

namespace weft {

/// Rest length [m], compliance [m/N] and damping time c/k [s] of each kind, in the order of
/// shared/params.h "constraints"; zeros where the scene has none of a kind.
template <class T>
using ConstraintRows = std::array<glm::vec<4, T>, shared::kConstraintRows>;

/// In double, before their one rounding.
ConstraintRows<double> constraint_rows_exact(const Model& model);

template <class T>
ConstraintRows<T> constraint_rows(const Model& model) {
  ConstraintRows<T> rows;
  const ConstraintRows<double> exact = constraint_rows_exact(model);
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = glm::vec<4, T>(exact[r]);
  return rows;
}

/// An item of xpbd_spring: two colours for each of the six kinds of springs.
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
inline constexpr std::uint32_t kBendColours = 6;  ///< three along i, three along j

}  // namespace weft
