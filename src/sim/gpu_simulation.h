// The plan on a Vulkan device: buffers, pipelines and prerecorded dispatches. The position and normal
// buffers are handed to the renderer as they are.
#pragma once
#include <vulkan/vulkan.h>

#include <memory>

#include "gpu/device.h"
#include "sim/simulation.h"

namespace weft {

/// What the renderer binds: the plan's final buffers, valid until the next advance().
struct DrawBuffers {
  VkBuffer position = VK_NULL_HANDLE;  ///< vec4, stride 16
  VkBuffer normal = VK_NULL_HANDLE;    ///< vec4, stride 16
};

class GpuSimulation : public Simulation {
 public:
  static std::unique_ptr<GpuSimulation> create(gpu::Device&, const Model&, const Solver&);
  virtual DrawBuffers draw_buffers() const = 0;
  /// Milliseconds of each plan step in the latest finished frame, in plan order; empty without timestamps.
  virtual std::vector<double> step_ms() const = 0;
};

}  // namespace weft
