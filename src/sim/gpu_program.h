// The plan's buffers and pipelines on a device, and how one of its steps is recorded. Shared by the
// simulation, which runs frames, and the validator, which runs single passes.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "gpu/recorder.h"
#include "plan/buffers.h"
#include "plan/plan.h"
#include "sim/gpu_pipelines.h"

namespace weft {

/// @throws Error(Exit::no_device) when a buffer of the plan exceeds what the device can bind, or all of them
///         its memory: bytes needed, bytes there, largest resolution that fits.
void require_fits(gpu::Device&, const Model&, const Plan&);

/// The plan's buffers, and only those. What the host writes each frame exists once a frame slot.
class GpuBuffers {
 public:
  GpuBuffers(gpu::Device&, const Model&, const Plan&);
  gpu::Buffer& at(BufferId id, std::uint32_t slot = 0);
  const gpu::Buffer& at(BufferId id, std::uint32_t slot = 0) const;
  bool has(BufferId id) const { return buffers_.contains(id); }
  /// Bytes of the buffers there are; the plan's promise is checked against it.
  std::uint64_t bytes() const;

 private:
  std::map<BufferId, std::vector<gpu::Buffer>> buffers_;
};

/// Which of the two halves of the ping-pong holds the state: 0 = position, 1 = position_next.
using Parity = std::uint32_t;

/// Pipelines, one for each distinct (pass, constants), and the descriptor sets of both parities and all
/// slots.
class GpuProgram {
 public:
  /// @param pipelines  where they are kept for the next program; null: for this one alone
  GpuProgram(gpu::Device&, const Plan&, const GpuBuffers&, std::shared_ptr<GpuPipelines> pipelines = nullptr);
  /// Records one dispatch of plan step `step`; `row` is its row of the substep table.
  void dispatch(gpu::Recorder&, std::size_t step, Parity, std::uint32_t slot, std::uint32_t row) const;
  /// Whether the step writes the state's other half, so that the parity changes after it.
  bool flips(std::size_t step) const;
  const gpu::ComputePipeline& pipeline(std::size_t step) const {
    return *kernels_[steps_[step].kernel].pipeline;
  }
  std::size_t pipeline_count() const { return kernels_.size(); }

 private:
  struct Kernel {
    std::string module;
    std::vector<std::uint32_t> constants;
    std::shared_ptr<const gpu::ComputePipeline> pipeline;
    std::uint32_t rows = 1;  ///< of particles, an invocation
    bool flips = false;
    std::vector<gpu::DescriptorSet> sets;  ///< [parity · kFrameSlots + slot]
  };
  struct Step {
    std::size_t kernel;
    std::uint32_t groups_x, groups_y, item;
  };
  std::size_t kernel_for(gpu::Device&, const PlanStep&, const GpuBuffers&, GpuPipelines&);
  std::vector<Kernel> kernels_;
  std::vector<Step> steps_;
};

/// The half of a ping-pong pair that a binding means at this parity: `position` of parity 1 is position_next.
BufferId at_parity(BufferId id, Parity parity);

}  // namespace weft
