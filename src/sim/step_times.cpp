// Substeps that were stamped as a whole, divided.
#include "sim/step_times.h"

#include <algorithm>
#include <numeric>

namespace weft {

void StepTimes::add(const TimedRun& run, double ms) {
  if (run.step == TimedRun::kSeveral) {
    several_ms_ += ms;
    return;
  }
  ms_[run.step] += ms;
  if (run.usual) usual_ms_[run.step] += ms;
}

std::vector<double> StepTimes::result() const {
  std::vector<double> result = ms_;
  if (several_ms_ == 0.0) return result;
  const auto sum = [](const std::vector<double>& of) { return std::accumulate(of.begin(), of.end(), 0.0); };
  const std::vector<double>& share = sum(usual_ms_) > 0.0 ? usual_ms_ : in_substeps_;
  const double whole = sum(share);
  for (std::size_t step = 0; step < result.size(); ++step) result[step] += several_ms_ * share[step] / whole;
  return result;
}

}  // namespace weft
