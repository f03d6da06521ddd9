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
#include "sim/kernels.h"

namespace weft {

/// @throws Error(Exit::no_device) when a buffer of the plan exceeds what the device can bind, or all of them
///         its memory: bytes needed, bytes there, largest resolution that fits.
void require_fits(gpu::Device&, const Model&, const Plan&);

/// @throws Error(Exit::no_device) when the plan computes in double and the device has no float64: names those
///         that have it.
void require_precision(const gpu::Device&, const Model&, const Plan&);

/// The plan's buffers and the kernel's scratch, and only those. What the host writes each frame exists once a
/// frame slot.
class GpuBuffers {
 public:
  /// @throws Error(Exit::no_device) as require_precision() and require_fits() say
  GpuBuffers(gpu::Device&, const Model&, const Plan&, const Kernel& kernel = {});
  gpu::Buffer& at(BufferId id, std::uint32_t slot = 0);
  const gpu::Buffer& at(BufferId id, std::uint32_t slot = 0) const;
  bool has(BufferId id) const { return buffers_.contains(id); }
  /// Bytes of the buffers there are; the plan's promise and the kernel's scratch are checked against it.
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
  /// @param kernel     that runs `integrate`; the buffers were made for it. Absent: direct_kernel()
  GpuProgram(gpu::Device&, const Plan&, const GpuBuffers&, std::shared_ptr<GpuPipelines> pipelines = nullptr,
             const std::optional<Kernel>& kernel = {});
  /// Records one dispatch of plan step `step`; `row` is its row of the substep table.
  /// @param substeps  that it takes, at most the kernel's; each reads the row after the one before
  void dispatch(gpu::Recorder&, std::size_t step, Parity, std::uint32_t slot, std::uint32_t row,
                std::uint32_t substeps = 1) const;
  const Kernel& kernel() const { return kernel_; }
  /// Whether the step writes the state's other half, so that the parity changes after it.
  bool flips(std::size_t step) const;
  const gpu::ComputePipeline& pipeline(std::size_t step) const {
    return *pipelines_[steps_[step].one.pipeline].pipeline;
  }
  std::size_t pipeline_count() const { return pipelines_.size(); }

 private:
  struct Pipeline {
    std::string module;
    std::vector<std::uint32_t> constants;
    std::shared_ptr<const gpu::ComputePipeline> pipeline;
    bool flips = false;
    std::vector<gpu::DescriptorSet> sets;  ///< [parity · kFrameSlots + slot]
  };
  struct Work {
    std::size_t pipeline;
    std::uint32_t groups_x, groups_y;
  };
  struct Step {
    Work one;                     ///< a dispatch of one substep
    std::optional<Work> several;  ///< of more, where the kernel can
    std::uint32_t item;
    const gpu::Buffer* groups = nullptr;  ///< where an indirect dispatch finds its workgroups
    VkDeviceSize groups_offset = 0;       ///< bytes
  };
  struct Variant;
  static Variant variant_for(const gpu::Device&, const PlanStep&, const Kernel&, bool several, bool doubles);
  Work work_for(gpu::Device&, const PlanStep&, const GpuBuffers&, GpuPipelines&, bool several);
  std::size_t pipeline_for(gpu::Device&, const PlanStep&, const Variant&, const GpuBuffers&, GpuPipelines&);
  Kernel kernel_;
  bool doubles_;
  Reaching reaching_;
  std::uint32_t sheet_rows_;
  bool tells_kicks_;
  std::vector<Pipeline> pipelines_;
  std::vector<Step> steps_;
};

/// The half of a ping-pong pair that a binding means at this parity: `position` of parity 1 is position_next.
BufferId at_parity(BufferId id, Parity parity);

}  // namespace weft
