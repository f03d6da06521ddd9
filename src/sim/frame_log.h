// When the latest frames ended and what they were made of, so that a verdict that a device gives later finds
// its frame.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "sim/divergence.h"

namespace weft {

class FrameLog {
 public:
  /// A state was written: frame 0.
  void begin(double time_s);
  void end_frame(double time_s, double frame_s, std::uint32_t substeps);
  /// Takes in the words of watch_state as they are by now: after every frame, at most a few frames late.
  void look(std::span<const std::uint32_t> watch_state);
  const std::optional<Divergence>& divergence() const { return divergence_; }
  /// Time of the latest sound state that was seen; nothing when there is none.
  const std::optional<double>& sound_time_s() const { return sound_time_s_; }

 private:
  struct Frame {
    double time_s = 0.0, frame_s = 0.0;
    std::uint32_t substeps = 0;
  };
  /// A verdict is late by at most the frames in flight.
  static constexpr std::size_t kRemembered = 8;
  std::array<Frame, kRemembered> frames_{};
  std::uint64_t latest_ = 0;
  std::optional<Divergence> divergence_;
  std::optional<double> sound_time_s_;
};

}  // namespace weft
