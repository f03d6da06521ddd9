// The plan on the CPU's vector units.
#pragma once
#include <memory>
#include <span>
#include <string>

#include "gpu/device.h"
#include "native/engine_options.h"
#include "sim/host_simulation.h"

namespace weft {

/// Why the vector kernels do not run this; empty when they do.
std::string native_lacks(const Model&, const Solver&, const std::string& precision);

/// Whether native computes where nobody names a device: the best that can be used is a software one, which
/// would run the shaders on these very cores.
bool native_by_default(std::span<const gpu::DeviceInfo> ranked);

/// The plan on the CPU's vector units, with the bits of the reference in f32. What they do not run
/// (native_lacks) runs on the reference; device_name() says which.
/// @throws Error(Exit::usage) as native::Engine does, and as make_cpu_simulation
std::unique_ptr<HostSimulation> make_native_simulation(const Model&, const Solver&,
                                                       const std::string& precision,
                                                       const native::EngineOptions& options = {});

}  // namespace weft
