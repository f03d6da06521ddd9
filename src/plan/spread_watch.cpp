// How many substeps to sweep between two looks, and what to do with frames that fold.
#include "plan/spread_watch.h"

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

constexpr std::uint32_t kSubstepsMost = 256, kFirstSubsteps = 4, kSubstepsLeast = 4;
constexpr double kCautionLeast = 1.5, kCautionMost = 12.0;
constexpr std::uint32_t kFramesPassedMost = 64, kFramesUntilSpread = 3;

}  // namespace

SpreadWatch::SpreadWatch(const Plan& plan, const Model& model) : bound_(plan, model) {}

bool SpreadWatch::tries_frame() {
  if (frames_to_pass_ == 0) return true;
  --frames_to_pass_;
  return false;
}

std::uint32_t SpreadWatch::substeps_from(const SpreadState& begin, double drift_s, std::uint32_t most) const {
  if (kick_m_s_ < 0.0) return std::min(most, kFirstSubsteps);
  SpreadState faster = begin;
  faster.apart_m_s *= 1.25;
  // The other half is before the next look.
  const std::uint32_t count =
      2 * bound_.substeps_within(faster, drift_s, caution_ * kick_m_s_, kSubstepsMost / 2);
  return count < kSubstepsLeast ? 0 : std::min(most, count);
}

bool SpreadWatch::stayed_spread(const SpreadState& begin, const SpreadState& end, double drift_s,
                                std::uint32_t substeps, float kick2) {
  kick_m_s_ = std::sqrt(double{kick2});
  if (end.margin < 0.0 || !std::isfinite(kick_m_s_)) return false;
  const double kick_m_s = (1.0 + 1e-5) * kick_m_s_;
  return bound_.substeps_within(begin, drift_s, kick_m_s, substeps) +
             bound_.substeps_within(end, drift_s, kick_m_s, substeps) >=
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

}  // namespace weft
