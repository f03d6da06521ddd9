// Prerecorded command buffers: a frame's dispatches cut into chunks, each recorded once and submitted as
// often as the same chunk comes again.
#pragma once
#include <compare>
#include <map>
#include <memory>
#include <vector>

#include "gpu/commands.h"
#include "sim/gpu_program.h"
#include "sim/step_times.h"

namespace weft {

/// A frame's dispatches in order: frame start, the substep block n times (a step with an interval in every so
/// many of them), frame end.
class DispatchOrder {
 public:
  struct Dispatch {
    std::size_t step;       ///< in the plan
    std::uint32_t substep;  ///< n after the last
    std::uint32_t count;    ///< substeps it takes: more than one only with a kernel that can
  };
  /// @param at_once  substeps the kernel takes into one dispatch; 1 unless the block is one pass
  DispatchOrder(const Plan& plan, std::uint32_t substeps, std::uint32_t at_once = 1);
  std::uint32_t count() const { return end_first_ + end_; }
  Dispatch operator[](std::uint32_t place) const;
  bool steps_alternate() const { return block_ > 1; }  ///< in the substeps
  /// Whether [first, first + count) lies where the order does not depend on n.
  bool independent_of_substeps(std::uint32_t first, std::uint32_t count) const;

 private:
  std::vector<Dispatch> period_;  // the substeps after which the intervals begin anew, numbered from 0
  std::uint32_t period_substeps_ = 1, substeps_ = 0, at_once_ = 1;
  std::uint32_t start_ = 0, end_ = 0;  // dispatches before and after the substeps
  std::uint32_t block_ = 0;            // steps of the substep block
  std::uint32_t end_first_ = 0;        // place of the first dispatch after the substeps
};

/// What makes two chunks the same commands.
struct ChunkKey {
  std::uint32_t slot, parity, first, count;
  std::uint32_t substeps;  ///< 0 where the commands do not depend on it
  auto operator<=>(const ChunkKey&) const = default;
};

class FrameCommands {
 public:
  /// A recorded chunk with its timestamps: one more than it has runs.
  struct Chunk {
    gpu::Commands commands;
    std::unique_ptr<gpu::Timer> timer;
    std::vector<TimedRun> runs;
    std::uint32_t dispatches = 0;  ///< counted while recording
    Parity parity_after = 0;
  };

  FrameCommands(gpu::Device& device, const Plan& plan, const GpuProgram& program)
      : device_(device), plan_(plan), program_(program) {}
  /// The chunk's commands, recorded now if they are new.
  Chunk& chunk(const ChunkKey& key, const DispatchOrder& order);
  bool crowded() const { return chunks_.size() > kMostChunks; }
  /// Lets go of everything recorded; the device must be done with all of it.
  void clear() { chunks_.clear(); }
  std::size_t recorded() const { return recorded_; }  ///< chunks recorded so far

 private:
  static constexpr std::size_t kMostChunks = 512;
  TimedRun run_at(const DispatchOrder& order, std::uint32_t place) const {
    const auto [step, substep, count] = order[place];
    return order.steps_alternate() ? run_of(plan_.steps[step], step, substep) : TimedRun{step, false};
  }
  std::unique_ptr<Chunk> record(const ChunkKey& key, const DispatchOrder& order) const;
  gpu::Device& device_;
  const Plan& plan_;
  const GpuProgram& program_;
  std::map<ChunkKey, std::unique_ptr<Chunk>> chunks_;
  std::size_t recorded_ = 0;
};

}  // namespace weft
