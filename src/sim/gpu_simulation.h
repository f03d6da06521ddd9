// The plan on a Vulkan device: buffers, pipelines and prerecorded dispatches. The position and normal
// buffers are handed to the renderer as they are.
#pragma once
#include <vulkan/vulkan.h>

#include <memory>
#include <string>

#include "gpu/device.h"
#include "sim/drawn_simulation.h"
#include "sim/gpu_pipelines.h"
#include "sim/kernel_choice.h"

namespace weft {

struct GpuSimulationOptions {
  std::uint32_t dispatches_per_submit = 0;  ///< 0: measured, so that a submit stays under about 50 ms
  std::string perturb;                      ///< "pass.constant" to falsify (perturb.h); empty: none
  std::shared_ptr<GpuPipelines> pipelines;  ///< shared with the simulation before this one; empty: its own
  std::string kernel;  ///< one of kernel_names(); empty: WEFT_KERNEL, else auto (choose_kernel)
  KernelTrial trial =
      KernelTrial::when_named;  ///< allowed: this run is long enough to time the kernels first
};

class GpuSimulation : public DrawnSimulation {
 public:
  /// Starts from start_state(model), with normals, on the device; the model is copied.
  /// @throws Error(Exit::no_device) when the cloth is too large for the device, before anything is allocated:
  ///         the bytes needed, the bytes there, and the largest resolution that fits.
  /// The scene's solver.precision decides how it computes; f64 draws from floats made at the frame's end.
  /// @throws Error(Exit::no_device) for f64 on a device without float64: names those that have it.
  /// @throws Error(Exit::usage) when the solver has no GPU passes or not this precision.
  static std::unique_ptr<GpuSimulation> create(gpu::Device&, const Model&, const Solver&,
                                               const GpuSimulationOptions& = {});
  /// Which kernel runs `integrate`, and who decided.
  virtual const KernelChoice& kernel() const = 0;
  /// Dispatches of a frame of that many substeps: the plan's, divided as the kernel says (dispatches_with).
  virtual std::uint64_t dispatches_expected(std::uint32_t substeps) const = 0;
  /// The plan's bytes and the kernel's scratch.
  virtual std::uint64_t bytes_expected() const = 0;
  /// Submits the latest advance() took.
  virtual std::uint32_t submit_count() const = 0;
};

}  // namespace weft
