// Pictures without a window: a colour image, the renderer, and the way back to the host.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "render/host_cloth.h"
#include "render/picture.h"
#include "render/renderer.h"

namespace weft {

struct RenderOptions {
  std::uint32_t width = 1280, height = 720;  ///< pixels
  std::uint32_t samples = 0;                 ///< 1 or 4; 0: 4 on a GPU, 1 on a software device
  Look look;
  std::optional<Camera> camera;   ///< absent: default_camera()
  double film_s = kSlideShown_s;  ///< what slides on a floor that leans is in the picture so long
};

class OffscreenRenderer {
 public:
  /// The device and the model must outlive the renderer.
  /// @throws Error(Exit::usage) when the size or the number of samples is not possible on the device
  OffscreenRenderer(gpu::Device& device, const Model& model, const RenderOptions& options);

  /// Draws the simulation's own buffers, waits, and returns the picture.
  Picture draw(const DrawBuffers& cloth, double time_s);
  /// Draws a state that lives on the host (a CPU simulation): uploads positions and vertex normals.
  Picture draw(const State& state);

  const DrawCounts& counts() const { return counts_; }  ///< of the latest picture
  const Renderer& renderer() const { return renderer_; }
  const Camera& camera() const { return camera_; }

 private:
  gpu::Device& device_;
  RenderOptions options_;
  Camera camera_;
  Renderer renderer_;
  gpu::Image color_;
  gpu::Buffer pixels_;
  std::optional<HostCloth> host_cloth_;
  DrawCounts counts_;
};

}  // namespace weft
