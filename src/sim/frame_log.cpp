// The latest frames, by number.
#include "sim/frame_log.h"

#include "shared/watch.h"

namespace weft {

void FrameLog::begin(double time_s) {
  latest_ = 0;
  frames_[0] = {.time_s = time_s};
  divergence_.reset();
  sound_time_s_.reset();
}

void FrameLog::end_frame(double time_s, double frame_s, std::uint32_t substeps) {
  frames_[++latest_ % kRemembered] = {.time_s = time_s, .frame_s = frame_s, .substeps = substeps};
}

void FrameLog::look(std::span<const std::uint32_t> watch_state) {
  if (divergence_) return;  // the words change no more
  if (const std::uint32_t sound = watch_state[shared::kWatchSound]; sound > 0)
    sound_time_s_ = frames_[(sound - 1) % kRemembered].time_s;
  divergence_ = divergence_in(watch_state);
  if (!divergence_) return;
  const Frame& frame = frames_[divergence_->frame % kRemembered];
  divergence_->time_s = frame.time_s;
  divergence_->frame_s = frame.frame_s;
  divergence_->substeps = frame.substeps;
}

}  // namespace weft
