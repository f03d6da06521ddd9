// What the accuracy panel sees of the running cloth: every few seconds the error of one frame, a few times a
// second stretch and energy. Made when the panel opens and freed when it closes.
#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "study/live.h"
#include "viewer/running_scene.h"

namespace weft {

/// One frame against the same frame with twice the substeps.
struct FrameError {
  double error_m = 0.0;        ///< RMS over particles
  double time_s = 0.0;         ///< of the frame's end
  double cost_ms = 0.0;        ///< of computing the frame again
  std::uint32_t substeps = 0;  ///< that the frame had
};

class LiveWatch {
 public:
  /// Once a picture: the next part of what is under way, at most about 50 ms on the device.
  void follow(RunningScene& running);

  const std::optional<FrameError>& frame_error() const { return error_; }
  /// Why there is no estimate; empty when there is one or it is on its way.
  const std::string& trouble() const { return trouble_; }
  const study::History& history() const { return history_; }
  /// Milliseconds a second of wall time that looking took, in the last seconds.
  double cost_ms_per_s() const { return cost_ms_per_s_; }
  std::uint64_t bytes() const { return copy_ ? copy_->bytes() : 0; }  ///< of the copy of the cloth
  double device_ms_per_s() const { return device_ms_per_s_; }  ///< simulated second, smoothed; 0: not known

 private:
  using Clock = std::chrono::steady_clock;
  void renew(const RunningScene&);
  void take(RunningScene&);
  void go_on();
  void measure_pace(const RunningScene&);

  std::unique_ptr<study::LiveError> copy_;
  study::History history_{600};
  std::optional<FrameError> error_;
  std::string trouble_;
  study::Setting setting_;
  std::uint64_t shown_version_ = 0, version_ = 0;
  double taken_s_ = 0.0, begun_s_ = 0.0;
  double spent_ms_ = 0.0, cost_ms_per_s_ = 0.0, device_ms_per_s_ = 0.0;
  Clock::time_point next_sample_{}, next_error_{}, tally_ = Clock::now();
};

}  // namespace weft
