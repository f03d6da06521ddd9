// The stable-step bound, gathered particle by particle: no memory beyond the model, O(particles).
#include "model/step_bound.h"

#include <algorithm>

#include "model/springs.h"

namespace weft {
namespace {

/// The four row sums of one particle, in 1/s² and 1/s.
struct RowSums {
  double stiffness_pairs = 0, stiffness_own = 0, damping_pairs = 0, damping_own = 0;
};

class Gather {
 public:
  explicit Gather(const Model& model) : model_(model), grid_(model.grid) {}

  RowSums at(std::uint32_t i, std::uint32_t j) const {
    RowSums sums;
    const double own = weight_of(i, j);
    for (const SpringKind& kind : model_.springs) {
      if (kind.stiffness_n_m <= 0.0) continue;
      add_spring(kind, static_cast<int>(i), static_cast<int>(j), kind.di, kind.dj, own, sums);
      add_spring(kind, static_cast<int>(i), static_cast<int>(j), -kind.di, -kind.dj, own, sums);
    }
    if (model_.bends()) {
      add_triples(i, j, true, own, sums);
      add_triples(i, j, false, own, sums);
    }
    return sums;
  }

 private:
  double weight_of(std::uint32_t i, std::uint32_t j) const {
    return model_.loosest_inverse_mass(grid_.index(i, j)) / model_.interior_mass_kg;
  }

  void add_spring(const SpringKind& kind, int i, int j, int di, int dj, double own, RowSums& sums) const {
    const int oi = i + di, oj = j + dj;
    if (oi < 0 || oi >= static_cast<int>(grid_.nx)) return;
    const int own_row = static_cast<int>(grid_.own_row(static_cast<std::uint32_t>(j)));
    if (own_row + dj < 0 || own_row + dj >= static_cast<int>(grid_.ny)) return;
    const auto ui = static_cast<std::uint32_t>(i), uj = static_cast<std::uint32_t>(j);
    const double other = weight_of(static_cast<std::uint32_t>(oi), static_cast<std::uint32_t>(oj));
    // The weight depends only on the line that the spring lies along, which both its ends share.
    const double weight = spring_weight(grid_, kind, ui, uj);
    const double k = weight * kind.stiffness_n_m, c = weight * kind.damping_n_s_m;
    sums.stiffness_pairs += k * (own + other);
    sums.stiffness_own += own * 2.0 * k;
    sums.damping_pairs += c * (own + other);
    sums.damping_own += own * 2.0 * c;
  }

  /// The up to three triples of one line through (i, j): those centred one before, here, and one after.
  void add_triples(std::uint32_t i, std::uint32_t j, bool along_i, double own, RowSums& sums) const {
    const std::uint32_t own_row = grid_.own_row(j), first = j - own_row;
    const std::uint32_t here = along_i ? i : own_row, count = along_i ? grid_.nx : grid_.ny;
    const double kappa = along_i ? model_.bend_kappa_n_m[0] * line_weight(own_row, grid_.ny)
                                 : model_.bend_kappa_n_m[1] * line_weight(i, grid_.nx);
    const auto at = [&](std::uint32_t place) {
      return along_i ? weight_of(place, j) : weight_of(i, first + place);
    };
    for (std::uint32_t middle = here > 0 ? here - 1 : 0; middle <= here + 1; ++middle) {
      if (middle == 0 || middle + 1 >= count) continue;
      sums.stiffness_pairs += kappa * (at(middle - 1) + 4.0 * at(middle) + at(middle + 1));
      sums.stiffness_own += own * kappa * (middle == here ? 8.0 : 4.0);
    }
  }

  const Model& model_;
  const Grid& grid_;
};

}  // namespace

StepBound step_bound(const Model& model) {
  const Gather gather(model);
  RowSums largest;
  for (std::uint32_t j = 0; j < model.grid.rows(); ++j) {
    for (std::uint32_t i = 0; i < model.grid.nx; ++i) {
      if (model.loosest_inverse_mass(model.grid.index(i, j)) == 0.0) continue;
      const RowSums sums = gather.at(i, j);
      largest.stiffness_pairs = std::max(largest.stiffness_pairs, sums.stiffness_pairs);
      largest.stiffness_own = std::max(largest.stiffness_own, sums.stiffness_own);
      largest.damping_pairs = std::max(largest.damping_pairs, sums.damping_pairs);
      largest.damping_own = std::max(largest.damping_own, sums.damping_own);
    }
  }
  return {std::min(largest.stiffness_pairs, largest.stiffness_own),
          std::min(largest.damping_pairs, largest.damping_own)};
}

}  // namespace weft
