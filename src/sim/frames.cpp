// The frames that a run of given length means.
#include <algorithm>
#include <cmath>

#include "sim/simulation.h"

namespace weft {

FramePlan frames_for(double time_s, double frame_s, std::uint32_t substeps) {
  constexpr double kSlack = 1e-6;  // of a frame: 5 s of 1/60 s are 300 frames, whatever the last bit says
  FramePlan plan;
  plan.whole = static_cast<std::uint64_t>(std::floor(time_s / frame_s + kSlack));
  const double rest_s = time_s - static_cast<double>(plan.whole) * frame_s;
  if (rest_s <= kSlack * frame_s) return plan;
  plan.rest_s = rest_s;
  plan.rest_substeps =
      static_cast<std::uint32_t>(std::max(1.0, std::ceil(substeps * rest_s / frame_s - kSlack)));
  return plan;
}

double frame_end_s(double start_s, double frame_s) {
  const double sum_s = start_s + frame_s;
  const double whole_s = std::round(sum_s / frame_s) * frame_s;
  return std::abs(whole_s - sum_s) <= 1e-9 * frame_s ? whole_s : sum_s;
}

}  // namespace weft
