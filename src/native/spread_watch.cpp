// The bounds are those of docs/float-form.md "Spread"; what rounding adds is counted, and a hundredth more.
#include "native/spread_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "native/motion_watch.h"
#include "passes/passes.h"

namespace weft::native {
namespace {

constexpr double kFlatDiagonal = 0.70710678;  // cells: what has no particle in common, across a diagonal
constexpr double kRounding = 6e-8;            // of a place [1]: half a unit
constexpr double kLess = 0.99;                // of what is allowed
constexpr std::uint32_t kSubstepsMost = 256, kFirstSubsteps = 4, kSubstepsLeast = 4;
constexpr double kCautionLeast = 1.5, kCautionMost = 12.0;
constexpr std::uint32_t kFramesPassedMost = 64, kFramesUntilSpread = 3;

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

bool sweep_watches_spread(const Plan& plan, const Model& model) {
  return model.scene.self_collision && model.grid.cloths == 1 && model.grid.nx > 1 && model.grid.ny > 1 &&
         sweep_alone_moves(plan);
}

SpreadWatch::SpreadWatch(const Plan& plan, const Model& model) : spacing_m_(model.grid.spacing_m) {
  const CollisionLayout layout = collision_layout(model);
  const double surfaces = layout.surface_reach_m / spacing_m_;
  spread_min_ = kRoundingRoom * std::max(surfaces, least_of_pairs(layout, spacing_m_, model));
  local_min_ = kRoundingRoom * std::max(spread_min_, surfaces / kFlatDiagonal);
  const double pause = interval_of(plan, pair_check) + interval_of(plan, cell_count);
  const double ways = shares_motion(model) ? 2.0 : 1.0;  // the common one is taken from everybody's
  way_max_m_ = kLess * (layout.roam_max_m - layout.stale_m) / (ways * pause);
}

bool SpreadWatch::tries_frame() {
  if (frames_to_pass_ == 0) return true;
  --frames_to_pass_;
  return false;
}

/// After (or before) m substeps neighbours are nearer or farther by m·drift·(apart + kick·(m + 3)) at most,
/// and by what rounding adds.
std::uint32_t SpreadWatch::substeps_within(const SpreadState& at, double drift_s, double kick_m_s,
                                           std::uint32_t most) const {
  const double room_m = kLess * at.margin * spacing_m_;
  const auto fits = [&](double m) {
    const double rounded_m =
        2.0 * m * kRounding * (at.place_m + m * drift_s * (at.shared_m_s + at.speed_m_s + m * kick_m_s));
    return m * drift_s * (at.apart_m_s + kick_m_s * (m + 3.0)) + rounded_m <= room_m &&
           drift_s * (at.speed_m_s + kick_m_s * (m + 1.0)) <= way_max_m_;
  };
  std::uint32_t low = 0, high = most + 1;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

std::uint32_t SpreadWatch::substeps_from(const SpreadState& begin, double drift_s, std::uint32_t most) const {
  if (kick_m_s_ < 0.0) return std::min(most, kFirstSubsteps);
  SpreadState faster = begin;
  faster.apart_m_s *= 1.25;
  // The other half is before the next look.
  const std::uint32_t count = 2 * substeps_within(faster, drift_s, caution_ * kick_m_s_, kSubstepsMost / 2);
  return count < kSubstepsLeast ? 0 : std::min(most, count);
}

bool SpreadWatch::stayed_spread(const SpreadState& begin, const SpreadState& end, double drift_s,
                                std::uint32_t substeps, float kick2) {
  kick_m_s_ = std::sqrt(double{kick2});
  if (end.margin < 0.0 || !std::isfinite(kick_m_s_)) return false;
  const double kick_m_s = (1.0 + 1e-5) * kick_m_s_;
  return substeps_within(begin, drift_s, kick_m_s, substeps) +
             substeps_within(end, drift_s, kick_m_s, substeps) >=
         substeps;
}

void SpreadWatch::pass_frames() { frames_to_pass_ = kFramesUntilSpread; }

void SpreadWatch::end_frame(bool spread) {
  if (spread) {
    caution_ = std::max(kCautionLeast, 0.98 * caution_);
    frames_passed_ = 1;
    return;
  }
  caution_ = std::min(kCautionMost, 2.0 * caution_);
  frames_to_pass_ = frames_passed_;
  frames_passed_ = std::min(kFramesPassedMost, 2 * frames_passed_);
  kick_m_s_ = -1.0;
}

}  // namespace weft::native
