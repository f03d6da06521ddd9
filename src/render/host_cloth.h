// A cloth whose state lives on the host, made drawable: for CPU simulations and synthetic sheets.
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "gpu/buffer.h"
#include "model/model.h"
#include "sim/gpu_simulation.h"

namespace weft {

/// Unit vertex normals: the normalised sum of the unnormalised cross products of the adjacent triangles.
/// A vertex whose triangles cancel or vanish has the normal 0.
std::vector<glm::vec4> vertex_normals(const Grid& grid, const State& state);

class HostCloth {
 public:
  HostCloth(gpu::Device& device, const Grid& grid);
  void upload(const State& state);
  DrawBuffers buffers() const { return {position_.handle(), normal_.handle()}; }

 private:
  Grid grid_;
  gpu::Buffer position_, normal_;
};

}  // namespace weft
