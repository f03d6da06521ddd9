// A scene that runs the same frame again and again from a given state, on a device that is timed: one side of
// a comparison by turns.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "gpu/device.h"
#include "model/model.h"
#include "plan/plan.h"
#include "sim/gpu_pipelines.h"

namespace weft {

/// What a run took.
struct RunTime {
  double once_ms = 0.0;      ///< on steps of the frame, where these can be told apart
  double substeps_ms = 0.0;  ///< on those of all substeps
  /// Of this process, all its threads; NaN where others do the work.
  double processor_ms = std::numeric_limits<double>::quiet_NaN();
};

class TimedScene {
 public:
  virtual ~TimedScene() = default;
  virtual const Plan& plan() const = 0;
  virtual void write(const State&) = 0;
  /// Goes on from where it is, untimed.
  virtual void advance(double time_s, std::uint32_t substeps) = 0;
  virtual State read() = 0;
  /// So many substeps of a frame, from `state` on.
  virtual RunTime run(const State& state, double time_s, std::uint32_t substeps) = 0;
  virtual std::uint64_t bytes() const = 0;
  virtual std::uint64_t dispatches(std::uint32_t substeps) const = 0;  ///< of a frame of so many
  virtual std::string runner() const = 0;  ///< what computes the forces, and who decided
  virtual std::uint32_t threads() const { return 1; }
};

/// By the device's timestamps, and by processor time where the device is a software one.
/// @param kernel  as GpuSimulationOptions::kernel; where it does not fit the plan, what runs unasked
std::unique_ptr<TimedScene> time_on_gpu(gpu::Device&, const Scene&, const std::string& kernel,
                                        std::shared_ptr<GpuPipelines>);

/// By the wall clock and by processor time. A run of few particles is repeated, and its mean counts.
/// @param threads  0: by trial
std::unique_ptr<TimedScene> time_on_native(const Scene&, std::uint32_t threads);

}  // namespace weft
