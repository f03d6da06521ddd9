// The plan on a Vulkan device: buffers, pipelines and prerecorded dispatches. The position and normal
// buffers are handed to the renderer as they are.
#pragma once
#include <vulkan/vulkan.h>

#include <memory>
#include <string>

#include "gpu/device.h"
#include "sim/simulation.h"

namespace weft {

/// What the renderer binds: the plan's final buffers, valid until the next advance().
struct DrawBuffers {
  VkBuffer position = VK_NULL_HANDLE;  ///< vec4, stride 16
  VkBuffer normal = VK_NULL_HANDLE;    ///< vec4, stride 16
};

struct GpuSimulationOptions {
  std::uint32_t dispatches_per_submit = 0;  ///< 0: measured, so that a submit stays under about 50 ms
  std::string perturb;                      ///< "pass.constant" to falsify (perturb.h); empty: none
};

class GpuSimulation : public Simulation {
 public:
  /// Starts from start_state(model), with normals, on the device; the model is copied.
  /// @throws Error(Exit::no_device) when the cloth is too large for the device, before anything is allocated:
  ///         the bytes needed, the bytes there, and the largest resolution that fits.
  /// @throws Error(Exit::usage) when the solver has no GPU passes.
  static std::unique_ptr<GpuSimulation> create(gpu::Device&, const Model&, const Solver&,
                                               const GpuSimulationOptions& = {});
  virtual DrawBuffers draw_buffers() const = 0;
  /// Milliseconds of each plan step in the latest finished frame, in plan order; empty without timestamps.
  virtual std::vector<double> step_ms() const = 0;
  /// Submits the latest advance() took.
  virtual std::uint32_t submit_count() const = 0;
  /// Returns when the device has finished every frame so far.
  virtual void wait() = 0;
};

}  // namespace weft
