// What the XPBD passes share on the CPU: coefficients of each kind of constraint. docs/solvers.md "xpbd".
#pragma once
#include <array>

#include "passes/spring_colours.h"
#include "passes/substep.h"
#include "shared/params.h"

namespace weft {

/// Rest length [m], compliance [m/N] and damping time c/k [s] of each kind, in the order of
/// shared/params.h "constraints", along i and then along j; zeros where the scene has none of a kind.
template <class T>
using ConstraintRows = std::array<glm::vec<4, T>, 2 * shared::kConstraintRows>;

/// From the rows along i to those along j, which are only there when they differ.
inline std::uint32_t constraint_shift(const Model& model) {
  return model.anisotropic() ? shared::kConstraintRows : 0;
}

/// In double, before their one rounding.
ConstraintRows<double> constraint_rows_exact(const Model& model);

template <class T>
ConstraintRows<T> constraint_rows(const Model& model) {
  ConstraintRows<T> rows;
  const ConstraintRows<double> exact = constraint_rows_exact(model);
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = glm::vec<4, T>(exact[r]);
  return rows;
}

inline constexpr std::uint32_t kBendColours = 6;  ///< three along i, three along j

}  // namespace weft
