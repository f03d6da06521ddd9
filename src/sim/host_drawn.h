// A cloth that the CPU computes, drawn by a Vulkan device: a thread of its own computes and writes positions
// and normals straight into the mapped vertex buffers that are drawn.
#pragma once
#include <memory>

#include "gpu/device.h"
#include "sim/host_simulation.h"

namespace weft {

/// Takes the simulation over. advance() and the parts of a frame run on the thread; everything else first
/// stops it between two parts.
std::unique_ptr<DrawnSimulation> draw_host_simulation(gpu::Device& device,
                                                      std::unique_ptr<HostSimulation> simulation);

}  // namespace weft
