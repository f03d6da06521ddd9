// A cloth whose state lives on the host, made drawable: for CPU simulations and synthetic sheets.
#pragma once
#include "gpu/buffer.h"
#include "model/model.h"
#include "sim/gpu_simulation.h"

namespace weft {

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
