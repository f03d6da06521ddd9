// The bounds are those of docs/float-form.md "Spread"; what rounding adds is counted, and a hundredth more.
#include "plan/spread_bound.h"

#include <algorithm>
#include <cmath>

#include "passes/collision.h"
#include "passes/passes.h"

namespace weft {
namespace {

constexpr double kFlatDiagonal = 0.70710678;  // cells: what has no particle in common, across a diagonal
constexpr double kRounding = 6e-8;            // of a place [1]: half a unit
constexpr double kLess = 0.99;                // of what is allowed

/// What of a distance on the flat cloth has to be left for pairs that are not neighbours to be out of each
/// other's reach.
double least_of_pairs(const CollisionLayout& layout, double spacing_m, const Model& model) {
  const auto limits = pair_limits(model, layout);
  double least = 0.0;
  constexpr std::uint32_t kTwoCells = 4;  // squared: nearer ones are neighbours
  for (std::uint32_t m = kTwoCells; m <= std::max(kTwoCells, layout.limit_last); ++m) {
    const double limit_m = limits[std::min(m, layout.limit_last)].limit;
    least = std::max(least, (limit_m + layout.skin_m) / (spacing_m * std::sqrt(static_cast<double>(m))));
  }
  return least;
}

std::uint32_t interval_of(const Plan& plan, const Pass& pass) {
  std::uint32_t most = 1;
  for (const PlanStep& step : plan.steps)
    if (step.pass == &pass) most = std::max(most, step.interval);
  return most;
}

}  // namespace

SpreadBound::SpreadBound(const Plan& plan, const Model& model) : spacing_m_(model.grid.spacing_m) {
  const CollisionLayout layout = collision_layout(model);
  const double surfaces = layout.surface_reach_m / spacing_m_;
  spread_min_ = kRoundingRoom * std::max(surfaces, least_of_pairs(layout, spacing_m_, model));
  local_min_ = kRoundingRoom * std::max(spread_min_, surfaces / kFlatDiagonal);
  const double pause = interval_of(plan, pair_check) + interval_of(plan, cell_count);
  const double ways = shares_motion(model) ? 2.0 : 1.0;  // the common one is taken from everybody's
  way_max_m_ = kLess * (layout.roam_max_m - layout.stale_m) / (ways * pause);
}

/// After (or before) m substeps neighbours are nearer or farther by m·drift·(apart + kick·(m + 3)) at most,
/// and by what rounding adds.
std::uint32_t SpreadBound::substeps_within(const SpreadState& at, double drift_s, double kick_m_s,
                                           std::uint32_t most, std::uint32_t late_kicks) const {
  const double room_m = kLess * at.margin * spacing_m_;
  const double apart_m_s = at.apart_m_s + 2.0 * late_kicks * kick_m_s,
               speed_m_s = at.speed_m_s + late_kicks * kick_m_s;
  const auto fits = [&](double m) {
    const double rounded_m =
        2.0 * m * kRounding * (at.place_m + m * drift_s * (at.shared_m_s + speed_m_s + m * kick_m_s));
    return m * drift_s * (apart_m_s + kick_m_s * (m + 3.0)) + rounded_m <= room_m &&
           drift_s * (speed_m_s + kick_m_s * (m + 1.0)) <= way_max_m_;
  };
  std::uint32_t low = 0, high = most + 1;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace weft
