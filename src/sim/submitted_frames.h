// What is under way on the device, frame slot by frame slot, and what its steps took.
#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include "gpu/device.h"
#include "sim/device_data.h"
#include "sim/frame_commands.h"
#include "sim/step_times.h"
#include "sim/submit_pacer.h"

namespace weft {

class SubmittedFrames {
 public:
  /// @param dispatches_per_submit  0: measured
  SubmittedFrames(gpu::Device& device, std::uint32_t dispatches_per_submit)
      : device_(device), pacers_{SubmitPacer(dispatches_per_submit), SubmitPacer(dispatches_per_submit)} {}

  /// The times of the plan's steps begin anew.
  void begin_frame(std::uint32_t slot, const Plan& plan);
  /// Of what is submitted from now on: which steps of the plan its own count as; null: they are the plan's.
  void count_as(std::uint32_t slot, const std::vector<std::size_t>* step_of) {
    slots_[slot].step_of = step_of;
  }
  void submit(std::uint32_t slot, FrameCommands::Chunk& chunk);
  /// Waits for what the slot runs and adds its times to the frame's.
  void finish(std::uint32_t slot);
  void finish_all();
  /// Waits so long at most [s]; whether all is finished.
  bool await(double wait_s) const;
  /// Adds what was done outside the frame's commands.
  void add(std::uint32_t slot, std::size_t step, double ms) { slots_[slot].times.add({step, false}, ms); }

  const SubmitPacer& pacer(std::uint32_t slot) const { return pacers_[slots_[slot].step_of != nullptr]; }
  const std::vector<double>& step_ms() const { return step_ms_; }
  double part_ms() const { return part_ms_; }            ///< of what was finished last
  std::uint32_t submit_count() const { return count_; }  ///< since the latest frame began

 private:
  using Clock = std::chrono::steady_clock;
  struct Slot {
    std::vector<FrameCommands::Chunk*> chunks;  // of the frame that runs in it
    const std::vector<std::size_t>* step_of = nullptr;
    std::uint64_t last_submit = 0;
    Clock::time_point start;
    StepTimes times;  // of the frame so far
  };

  gpu::Device& device_;
  std::array<SubmitPacer, 2> pacers_;  // of the plan's own steps; of others
  std::array<Slot, kFrameSlots> slots_;
  std::vector<double> step_ms_;
  double part_ms_ = 0.0;
  std::uint32_t count_ = 0;
};

}  // namespace weft
