// What each step of a plan took on a device in a frame. A time stamp makes a device wait, some as long as a
// small dispatch takes, so that most substeps of several passes are stamped as a whole.
#pragma once
#include <cstdint>
#include <vector>

#include "plan/plan.h"

namespace weft {

/// Dispatches in a row between two stamps.
struct TimedRun {
  static constexpr std::size_t kSeveral = SIZE_MAX;
  std::size_t step = kSeveral;  ///< of the plan; kSeveral: of whole substeps
  bool usual = false;           ///< of a substep that stands for those between: any but a frame's first
  bool operator==(const TimedRun&) const = default;
};

/// The run that a dispatch belongs to. Every 17th substep has its steps stamped, since intervals of passes
/// are even as a rule, and each of the first few, so that short frames are measured whole.
inline TimedRun run_of(const PlanStep& planned, std::size_t step, std::uint32_t substep) {
  constexpr std::uint32_t kFirst = 4, kEvery = 17;
  if (planned.block != Block::substep) return {step, false};
  if (substep >= kFirst && substep % kEvery != 0) return {};
  return {step, substep > 0};
}

/// Sums of a frame.
class StepTimes {
 public:
  StepTimes() = default;
  explicit StepTimes(const Plan& plan) : ms_(plan.steps.size()), usual_ms_(plan.steps.size()) {
    for (const PlanStep& step : plan.steps)
      in_substeps_.push_back(step.block == Block::substep ? double(step.repeat) : 0.0);
  }
  void add(const TimedRun& run, double ms);
  /// Milliseconds of each step: those between stamps, and of what was stamped as a whole its usual share.
  std::vector<double> result() const;

 private:
  std::vector<double> ms_, usual_ms_;
  std::vector<double> in_substeps_;  ///< dispatches a frame of those that substeps have
  double several_ms_ = 0.0;
};

}  // namespace weft
