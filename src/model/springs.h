// Walks over what joins particles: springs and straight bending triples, with their boundary weights. One
// enumeration serves counts, energies and the step bound; the passes have their own, independent one.
#pragma once
#include <cstdint>

#include "model/model.h"

namespace weft {

/// Weight of a line of springs or triples: ½ on the first and last line, else 1.
inline double line_weight(std::uint32_t line, std::uint32_t line_count) {
  return line == 0 || line + 1 == line_count ? 0.5 : 1.0;
}

/// Boundary weight of the spring of `kind` that starts at (i, j).
inline double spring_weight(const Grid& grid, const SpringKind& kind, std::uint32_t i, std::uint32_t j) {
  if (!kind.halves_on_boundary) return 1.0;
  return kind.dj == 0 ? line_weight(grid.own_row(j), grid.ny) : line_weight(i, grid.nx);
}

/// Calls visit(a, b, weight) for every join of the kind inside the grid that has a free end.
template <class Visit>
void for_each_join(const Model& model, const SpringKind& kind, Visit&& visit) {
  const Grid& grid = model.grid;
  const std::uint32_t first = kind.di < 0 ? static_cast<std::uint32_t>(-kind.di) : 0u;
  const std::uint32_t reach = kind.di > 0 ? static_cast<std::uint32_t>(kind.di) : 0u;
  for (std::uint32_t j = 0; j < grid.rows(); ++j) {
    if (grid.own_row(j) + static_cast<std::uint32_t>(kind.dj) >= grid.ny) continue;
    for (std::uint32_t i = first; i + reach < grid.nx; ++i) {
      const std::uint32_t a = grid.index(i, j);
      const std::uint32_t b = grid.index(static_cast<std::uint32_t>(static_cast<int>(i) + kind.di),
                                         j + static_cast<std::uint32_t>(kind.dj));
      if (model.loosest_inverse_mass(a) == 0.0 && model.loosest_inverse_mass(b) == 0.0) continue;
      visit(a, b, spring_weight(grid, kind, i, j));
    }
  }
}

/// Calls visit(kind, a, b, weight) for every spring: kinds with k = 0 are absent.
template <class Visit>
void for_each_spring(const Model& model, Visit&& visit) {
  for (const SpringKind& kind : model.springs) {
    if (kind.stiffness_n_m <= 0.0) continue;
    for_each_join(model, kind,
                  [&](std::uint32_t a, std::uint32_t b, double weight) { visit(kind, a, b, weight); });
  }
}

/// Calls visit(minus, middle, plus, kappa) for every straight triple; nothing without bending.
template <class Visit>
void for_each_triple(const Model& model, Visit&& visit) {
  if (!model.bends()) return;
  const Grid& grid = model.grid;
  for (std::uint32_t row = 0; row < grid.rows(); ++row) {
    const std::uint32_t j = grid.own_row(row);
    for (std::uint32_t i = 0; i < grid.nx; ++i) {
      const std::uint32_t middle = grid.index(i, row);
      if (i > 0 && i + 1 < grid.nx)
        visit(middle - 1, middle, middle + 1, model.bend_kappa_n_m[0] * line_weight(j, grid.ny));
      if (j > 0 && j + 1 < grid.ny)
        visit(middle - grid.nx, middle, middle + grid.nx, model.bend_kappa_n_m[1] * line_weight(i, grid.nx));
    }
  }
}

}  // namespace weft
