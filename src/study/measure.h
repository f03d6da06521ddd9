// Running one setting on a device: its error against the reference, its time, its other measures.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "gpu/device.h"
#include "sim/gpu_pipelines.h"
#include "sim/host_simulation.h"
#include "study/point.h"
#include "study/reference.h"

namespace weft::study {

/// Where settings run: a Vulkan device; where there is none the CPU reference, or native.
struct Bench {
  gpu::Device* device = nullptr;
  std::string label;                                  ///< as summaries name it; software devices say so
  std::shared_ptr<GpuPipelines> pipelines = nullptr;  ///< shared by all runs on the device
  bool native = false;  ///< without a device: the CPU's vector units for what they run
  /// A simulation without a device.
  std::unique_ptr<HostSimulation> on_host(const Model&, const Solver&, const std::string& precision) const;
  /// Of the CPU's vector units, or of the reference.
  static Bench without_device(bool native);
};

struct MeasureOptions {
  std::uint32_t run_count_max = 5;  ///< timed runs; the median counts
  double timing_s = 3.0;            ///< no further timed run is begun after this
  bool energy_drift = true;         ///< one more run without damping and air
};

/// The precisions there are, in the order they are swept and shown.
std::span<const std::string_view> precisions();

/// Why a solver does not run in a precision on this bench; empty when it does.
std::string unavailable(const Bench& bench, const Model& model, const Solver& solver,
                        std::string_view precision);

/// Runs the setting over the reference's frames.
/// @param equilibrium  positions at rest, or empty when the scene has none
/// @throws Error(Exit::interrupted)
Point measure(const Bench& bench, const Model& model, const Setting& setting, const Reference& reference,
              const std::vector<glm::dvec3>& equilibrium, const MeasureOptions& options, const Stop& stop);

}  // namespace weft::study
