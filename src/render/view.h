// From a model, a camera and a time to the uniform block that the draw shaders read.
#pragma once
#include "draw/view.h"
#include "render/camera.h"

namespace weft {

/// What does not change while a scene is drawn.
struct Stage {
  Bounds bounds;
  std::uint32_t shadow_size = 0;  ///< texels along an edge of the shadow map
};

/// @param heat_full  strain that the heat map paints in full colour
shared::View make_view(const Model& model, const Stage& stage, const Camera& camera, double aspect,
                       double time_s, double heat_full);

/// Colliding spheres and pin heads that are drawn, at most shared::kMaxBalls.
std::uint32_t ball_count(const Model& model);

}  // namespace weft
