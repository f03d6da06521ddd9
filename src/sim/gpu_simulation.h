// The plan on a Vulkan device: buffers, pipelines and prerecorded dispatches. The position and normal
// buffers are handed to the renderer as they are.
#pragma once
#include <vulkan/vulkan.h>

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>

#include "gpu/device.h"
#include "sim/gpu_pipelines.h"
#include "sim/kernel_choice.h"
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
  std::shared_ptr<GpuPipelines> pipelines;  ///< shared with the simulation before this one; empty: its own
  std::string kernel;  ///< one of kernel_names(); empty: WEFT_KERNEL, else auto (choose_kernel)
  KernelTrial trial =
      KernelTrial::when_named;  ///< allowed: this run is long enough to time the kernels first
};

/// A pinned particle that something outside the plan moves: a hand.
struct PlacedParticle {
  std::uint32_t particle = 0;
  glm::vec3 position_m{0.0f}, velocity_m_s{0.0f};
};

class GpuSimulation : public Simulation {
 public:
  /// Starts from start_state(model), with normals, on the device; the model is copied.
  /// @throws Error(Exit::no_device) when the cloth is too large for the device, before anything is allocated:
  ///         the bytes needed, the bytes there, and the largest resolution that fits.
  /// The scene's solver.precision decides how it computes; f64 draws from floats made at the frame's end.
  /// @throws Error(Exit::no_device) for f64 on a device without float64: names those that have it.
  /// @throws Error(Exit::usage) when the solver has no GPU passes or not this precision.
  static std::unique_ptr<GpuSimulation> create(gpu::Device&, const Model&, const Solver&,
                                               const GpuSimulationOptions& = {});
  virtual DrawBuffers draw_buffers() const = 0;
  /// Milliseconds of each plan step in the latest finished frame, in plan order; empty without timestamps.
  virtual std::vector<double> step_ms() const = 0;
  /// Which kernel runs `integrate`, and who decided.
  virtual const KernelChoice& kernel() const = 0;
  /// Dispatches of a frame of that many substeps: the plan's, divided as the kernel says (dispatches_with).
  virtual std::uint64_t dispatches_expected(std::uint32_t substeps) const = 0;
  /// The plan's bytes and the kernel's scratch.
  virtual std::uint64_t bytes_expected() const = 0;
  /// Submits the latest advance() took.
  virtual std::uint32_t submit_count() const = 0;
  /// Returns when the device has finished every frame so far.
  virtual void wait() = 0;

  /// advance() in parts, for a window that must answer meanwhile: begins a frame, computing nothing yet. What
  /// was left of an unfinished one is dropped; the state stays where that one had come to.
  virtual void begin_frame(double frame_s, std::uint32_t substeps) = 0;
  /// Submits the next part of the frame, at most about 50 ms of work. Returns whether more is left.
  virtual bool continue_frame() = 0;
  /// In the middle of a frame: makes draw_buffers() show the state as it is by now. Waits for the device.
  virtual void refresh_normals() = 0;

  /// Takes another model that leads to the same plan (passes, constants, ranges, buffers): rewrites what the
  /// parameters say and who is pinned, keeps the state. Returns false, changing nothing, for another plan.
  virtual bool adopt(const Model&) = 0;
  /// Puts particles that the model pins in place, before the next frame or part of one.
  /// @throws Error(Exit::internal) for a particle that is not pinned: the plan would move it on
  virtual void place(std::span<const PlacedParticle>) = 0;
};

}  // namespace weft
