// Vertex buffers for a cloth that the host computes: one pair is shown while another one is written.
#pragma once
#include <array>
#include <glm/vec4.hpp>
#include <vector>

#include "gpu/buffer.h"
#include "native/surface_target.h"
#include "sim/drawn_simulation.h"

namespace weft {

/// For the thread that owns the device, but for what target() points to.
class DrawPairs {
 public:
  /// @param model  whose cloth is drawn
  DrawPairs(gpu::Device& device, const Model& model);
  /// Where the next state may be written: no picture reads it any more.
  native::SurfaceTarget target();
  /// The target is written: from now on it is what is drawn.
  void show();
  DrawBuffers shown() const {
    const Pair& pair = pairs_[shown_];
    return {pair.position.handle(), pair.normal.handle(),
            pair.torn_mesh ? pair.torn_mesh.handle() : VK_NULL_HANDLE};
  }
  std::uint64_t bytes() const;

 private:
  struct Pair {
    gpu::Buffer position, normal;
    gpu::Buffer torn_mesh;                                  ///< only of a cloth that tears
    std::vector<glm::vec4> staged_position, staged_normal;  ///< where the host does not see device memory
    std::vector<std::uint32_t> staged_mesh;
    std::uint64_t shown_since = 0;  ///< the device's timeline when it was shown
    std::uint64_t read_until = 0;   ///< what must be finished before it is written
  };
  gpu::Device& device_;
  /// One is shown, one is written, and two pictures in flight may read two more: nobody waits.
  std::array<Pair, 4> pairs_;
  std::size_t shown_ = 0, target_ = 0;
};

}  // namespace weft
