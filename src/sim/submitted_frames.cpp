// Timestamps of finished chunks become the times of steps.
#include "sim/submitted_frames.h"

#include <algorithm>

namespace weft {

void SubmittedFrames::begin_frame(std::uint32_t slot, const Plan& plan) {
  slots_[slot].times = StepTimes(plan);
  count_ = 0;
}

void SubmittedFrames::submit(std::uint32_t slot, FrameCommands::Chunk& chunk) {
  Slot& in = slots_[slot];
  if (in.chunks.empty()) in.start = Clock::now();
  in.last_submit = device_.submit(chunk.commands.handle());
  in.chunks.push_back(&chunk);
  ++count_;
}

void SubmittedFrames::finish(std::uint32_t slot) {
  Slot& in = slots_[slot];
  if (in.chunks.empty()) return;
  device_.wait(in.last_submit);
  double total_ms = 0;
  std::uint32_t dispatches = 0;
  for (const FrameCommands::Chunk* chunk : in.chunks) {
    dispatches += chunk->dispatches;
    for (std::uint32_t run = 0; run < chunk->runs.size() && device_.info().timestamps; ++run) {
      const double ms = std::max(chunk->timer->between_ms(run, run + 1), 0.0);
      TimedRun timed = chunk->runs[run];
      if (in.step_of != nullptr && timed.step != TimedRun::kSeveral) timed.step = (*in.step_of)[timed.step];
      in.times.add(timed, ms);
      total_ms += ms;
    }
  }
  if (device_.info().timestamps)
    step_ms_ = in.times.result();
  else  // the wall clock is an upper bound: the submits also waited for others
    total_ms = std::chrono::duration<double, std::milli>(Clock::now() - in.start).count();
  part_ms_ = total_ms;
  pacers_[in.step_of != nullptr].measured(dispatches, total_ms);
  in.chunks.clear();
}

void SubmittedFrames::finish_all() {
  for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) finish(slot);
}

bool SubmittedFrames::await(double wait_s) const {
  return std::ranges::all_of(slots_, [&](const Slot& slot) {
    return slot.chunks.empty() || device_.wait_for(slot.last_submit, wait_s);
  });
}

}  // namespace weft
