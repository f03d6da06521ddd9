// A running cloth that can be drawn as it is: its vertex buffers, its frames in parts, its changes under way.
#pragma once
#include <vulkan/vulkan.h>

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "sim/simulation.h"

namespace weft {

/// What the renderer binds: where positions and normals are, valid until the next advance().
struct DrawBuffers {
  VkBuffer position = VK_NULL_HANDLE;  ///< vec4, stride 16
  VkBuffer normal = VK_NULL_HANDLE;    ///< vec4, stride 16
  /// Indices of a torn cloth's triangles, then lines; null: all are whole.
  VkBuffer torn_mesh = VK_NULL_HANDLE;
};

/// A pinned particle that something outside the plan moves: a hand.
struct PlacedParticle {
  std::uint32_t particle = 0;
  glm::vec3 position_m{0.0f}, velocity_m_s{0.0f};
};

class DrawnSimulation : public Simulation {
 public:
  virtual DrawBuffers draw_buffers() const = 0;
  /// Simulated time [s] of what draw_buffers() shows: a thread of its own may have come further.
  virtual double shown_time_s() const { return time_s(); }
  /// Milliseconds of each plan step in the latest finished frame, in plan order; empty when nobody knows.
  virtual std::vector<double> step_ms() const = 0;
  /// Returns when every part of a frame that was begun with continue_frame() is finished.
  virtual void wait() = 0;

  /// advance() in parts, for a window that must answer meanwhile: begins a frame, computing nothing yet. What
  /// was left of an unfinished one is dropped; the state stays where that one had come to.
  virtual void begin_frame(double frame_s, std::uint32_t substeps) = 0;
  /// Begins or awaits the next part of the frame, at most about 50 ms. Returns whether more is left.
  virtual bool continue_frame() = 0;
  /// Waits so long at most [s] for the part that continue_frame() began. Returns whether it is finished: what
  /// else asks for the state waits for it in any case.
  virtual bool await_part(double wait_s) = 0;
  /// Milliseconds that the latest part took that await_part() or wait() found finished, without what the
  /// device did before it.
  virtual double part_ms() const = 0;
  /// In the middle of a frame: makes draw_buffers() show the state as it is by now. Waits for it.
  virtual void refresh_normals() = 0;

  /// Takes another model that leads to the same plan (passes, constants, ranges, buffers): rewrites what the
  /// parameters say and who is pinned, keeps the state. Returns false, changing nothing, for another plan.
  virtual bool adopt(const Model&) = 0;
  /// Puts particles that the model pins in place, before the next frame or part of one.
  /// @throws Error(Exit::internal) for a particle that is not pinned: the plan would move it on
  virtual void place(std::span<const PlacedParticle>) = 0;
};

/// Whether what was made for one plan (commands, variants of kernels) runs the other as it is.
bool same_commands(const Plan& a, const Plan& b);

/// @throws Error(Exit::internal) when a particle to be placed is not pinned
void require_pinned(const Model& model, std::span<const PlacedParticle> particles);

}  // namespace weft
