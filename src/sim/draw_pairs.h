// Vertex buffers for a cloth that the host computes: one pair is shown while others are written.
#pragma once
#include <array>
#include <glm/vec4.hpp>
#include <vector>

#include "gpu/buffer.h"
#include "native/surface_target.h"
#include "sim/drawn_simulation.h"

namespace weft {

/// For the thread that owns the device, but for what a taken pair points to.
class DrawPairs {
 public:
  /// A pair that somebody writes: his until it is shown.
  struct Taken {
    std::size_t pair = 0;
    native::SurfaceTarget surface{};
  };

  /// @param model  whose cloth is drawn
  DrawPairs(gpu::Device& device, const Model& model);
  /// Waits for the pictures that read the pairs.
  ~DrawPairs();
  DrawPairs(const DrawPairs&) = delete;
  DrawPairs& operator=(const DrawPairs&) = delete;
  /// A pair that no picture reads any more. At most two are taken at a time.
  Taken take();
  /// The pair is written: from now on it is what is drawn.
  void show(const Taken& taken);
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
    bool taken = false;
  };
  gpu::Device& device_;
  /// One is shown, one is written, one is written and not yet shown, and two pictures in flight may read two
  /// more: nobody waits.
  std::array<Pair, 5> pairs_;
  std::size_t shown_ = 0;
};

}  // namespace weft
