// Rounding: a place in float is off by half a unit, which a particle may gain in every substep; what the
// mirror computes of a way is off by some units of the way. The room is a hundredth less for it.
#include "native/motion_watch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "passes/collision.h"
#include "passes/passes.h"

namespace weft::native {
namespace {

constexpr double kMoreLeast = 0.02, kMoreMost = 0.25, kRounding = 4e-7, kLess = 0.99, kSubstepsMost = 4096.0;

}  // namespace

bool sweep_alone_moves(const Plan& plan) {
  return std::ranges::all_of(plan.steps, [](const PlanStep& step) {
    return step.block != Block::substep || step.pass == &integrate || serves_self_collision(*step.pass);
  });
}

bool sweep_watches_motion(const Plan& plan, const Model& model) {
  return model.scene.self_collision && !shares_motion(model) && sweep_alone_moves(plan);
}

void MotionWatch::tell_sweeps(std::uint32_t substeps, float drift_s) {
  used_m_ += substeps * way_m_;
  swept_ += substeps;
  if (drift_s > 0.0f) drift_s_ = drift_s;  // a frame ends with a kick alone
}

void MotionWatch::take_back(std::uint32_t substeps) {
  used_m_ -= substeps * way_m_;
  swept_ -= substeps;
  leapt_ = false;
  one_by_one_ = true;
}

/// The ways of all but the last must fit into the room: after that one somebody may look.
std::uint32_t MotionWatch::quiet_substeps() const {
  if (leap2_ == kNoLeap || one_by_one_ || !all_are_in()) return 0;
  return 1 + static_cast<std::uint32_t>(std::min((room_m_ - used_m_) / way_m_, kSubstepsMost));
}

/// As much more as the greatest speed may change by, at twice the rate since the last look, until the room is
/// used up.
double MotionWatch::more_at(double speed_m_s) const {
  const double way_m = speed_m_s * drift_s_;
  if (speed_m_s_ < 0.0 || swept_ == 0 || !(way_m > 0.0)) return kMoreMost;
  const double change = std::abs(speed_m_s - speed_m_s_) / (speed_m_s * swept_);
  return std::clamp(kMoreLeast + 2.0 * change * room_most_m_ / way_m, kMoreLeast, kMoreMost);
}

void MotionWatch::measured(float gone2, float speed2, float place2) {
  const double speed_m_s = std::sqrt(double{speed2});
  const double way_m = (1.0 + more_at(speed_m_s)) * speed_m_s * drift_s_ + 1e-4 * room_most_m_;
  speed_m_s_ = speed_m_s;
  swept_ = 0;
  leap2_ = static_cast<float>(kLess * way_m * way_m);
  way_m_ = way_m + kRounding * (std::sqrt(double{place2}) + room_most_m_);
  room_m_ = kLess * room_most_m_ - std::sqrt(double{gone2});
  used_m_ = 0.0;
  leapt_ = one_by_one_ = false;
}

void MotionWatch::lists_made() {
  if (leap2_ == kNoLeap) return;  // nobody has been measured
  room_m_ = kLess * room_most_m_;
  used_m_ = 0.0;
}

void MotionWatch::forget() {
  leap2_ = kNoLeap;
  room_m_ = -1.0;
  used_m_ = 0.0;
  speed_m_s_ = -1.0;
  leapt_ = one_by_one_ = false;
}

}  // namespace weft::native
