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
  DrawBuffers buffers() const {
    return {position_.handle(), normal_.handle(), torn_mesh_ ? torn_mesh_.handle() : VK_NULL_HANDLE};
  }

 private:
  gpu::Device& device_;
  Grid grid_;
  gpu::Buffer position_, normal_, torn_mesh_;  ///< the last only once something is torn
};

}  // namespace weft
