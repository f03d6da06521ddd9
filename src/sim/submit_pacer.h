// How many dispatches go into one submit, so that neither a window nor a driver's watchdog stalls.
#pragma once
#include <cstdint>

namespace weft {

/// Learns the time of a dispatch and answers with a power of two, so that recorded chunks are used again.
class SubmitPacer {
 public:
  /// @param fixed  dispatches a submit, when not to be measured; 0: measured
  explicit SubmitPacer(std::uint32_t fixed = 0) : fixed_(fixed) {}
  /// Dispatches for the next submit.
  std::uint32_t chunk() const { return fixed_ > 0 ? fixed_ : chunk_; }
  /// Whether the next submits should be waited for and measured one by one: the first compiles on some
  /// drivers, so that only the second tells.
  bool learning() const { return fixed_ == 0 && measured_ < 2; }
  /// A submit of `dispatches` took `ms`.
  void measured(std::uint32_t dispatches, double ms);

 private:
  static constexpr double kTargetMs = 40.0;  // a submit; the powers of two keep it between half of it and it
  static constexpr std::uint32_t kMost = 4096;
  std::uint32_t fixed_ = 0, chunk_ = 2, measured_ = 0;
};

}  // namespace weft
