// How many dispatches go into one submit.
#include "sim/submit_pacer.h"

#include <algorithm>
#include <bit>

namespace weft {

void SubmitPacer::measured(std::uint32_t dispatches, double ms) {
  if (dispatches == 0 || ms <= 0) return;
  ++measured_;
  const double one_ms = ms / dispatches;
  // A chunk that fits is kept until it is a third too long or three times too short: no flutter.
  const double now_ms = one_ms * chunk_;
  if (measured_ > 2 && now_ms < kTargetMs * 1.2 && now_ms > kTargetMs / 3) return;
  const double wanted = std::clamp(kTargetMs / one_ms, 1.0, double{kMost});
  chunk_ = std::bit_floor(static_cast<std::uint32_t>(wanted));
}

}  // namespace weft
