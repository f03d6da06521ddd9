// Nearest pinned particles by two passes: along every column, then along every row over the columns' nearest.
#include "model/tethers.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace weft {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// For every particle the nearest pinned row of its own column; kNone where the column has no pin.
std::vector<std::uint32_t> nearest_rows(const Model& model) {
  const Grid& grid = model.grid;
  std::vector<std::uint32_t> nearest(grid.count(), kNone);
  for (std::uint32_t i = 0; i < grid.nx; ++i) {
    std::uint32_t last = kNone;
    const auto look = [&](std::uint32_t j) {
      const std::uint32_t p = grid.index(i, j);
      if (model.loosest_inverse_mass(p) == 0.0) last = j;
      if (last == kNone) return;
      const auto away = [&](std::uint32_t row) { return row > j ? row - j : j - row; };
      if (nearest[p] == kNone || away(last) < away(nearest[p])) nearest[p] = last;
    };
    for (std::uint32_t j = 0; j < grid.ny; ++j) look(j);
    last = kNone;
    for (std::uint32_t j = grid.ny; j-- > 0;) look(j);
  }
  return nearest;
}

/// The nearest of one row's particles, whose columns' nearest rows are known.
class RowSearch {
 public:
  RowSearch(const Grid& grid, const std::vector<std::uint32_t>& rows, std::uint32_t j) : grid_(grid) {
    heights_.assign(grid.nx, kFar);
    for (std::uint32_t i = 0; i < grid.nx; ++i)
      if (const std::uint32_t row = rows[grid.index(i, j)]; row != kNone) {
        heights_[i] = squared(static_cast<double>(row) - j);
        anchors_.push_back(grid.index(i, row));
      } else {
        anchors_.push_back(kNone);
      }
    lowest_ = *std::ranges::min_element(heights_);
  }

  /// The anchor of column i and its squared distance in cells.
  std::pair<std::uint32_t, double> at(std::uint32_t i) const {
    double best = heights_[i];
    std::uint32_t anchor = anchors_[i];
    for (std::uint32_t away = 1; away < grid_.nx && squared(away) + lowest_ < best; ++away)
      for (const bool left : {true, false}) {
        if (left ? i < away : i + away >= grid_.nx) continue;
        const std::uint32_t column = left ? i - away : i + away;
        if (squared(away) + heights_[column] >= best) continue;
        best = squared(away) + heights_[column];
        anchor = anchors_[column];
      }
    return {anchor, best};
  }

 private:
  static constexpr double kFar = 1e18;
  static double squared(double x) { return x * x; }

  const Grid& grid_;
  std::vector<double> heights_;  ///< squared distance along the column
  std::vector<std::uint32_t> anchors_;
  double lowest_ = kFar;
};

}  // namespace

std::vector<Tether> find_tethers(const Model& model, double slack) {
  const Grid& grid = model.grid;
  bool any = false;
  for (std::uint32_t p = 0; p < grid.count() && !any; ++p) any = model.loosest_inverse_mass(p) == 0.0;
  if (!any)
    throw error(
        Exit::usage,
        "{}: [tethers] has nothing to hold on to; it must have a pin that never lets go (add [[pins]], or "
        "remove the section)",
        place_of(model.scene, "tethers"));
  const std::vector<std::uint32_t> rows = nearest_rows(model);
  std::vector<Tether> tethers(grid.count());
  for (std::uint32_t j = 0; j < grid.ny; ++j) {
    const RowSearch search(grid, rows, j);
    for (std::uint32_t i = 0; i < grid.nx; ++i) {
      const auto [anchor, squared_cells] = search.at(i);
      tethers[grid.index(i, j)] = {anchor, (1.0 + slack) * grid.spacing_m * std::sqrt(squared_cells)};
      if (squared_cells == 0.0) tethers[grid.index(i, j)].reach_m = -1.0;
    }
  }
  return tethers;
}

}  // namespace weft
