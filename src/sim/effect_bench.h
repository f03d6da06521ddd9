// What each effect of a scene costs on a device: the scene with it and without it, by turns in one run.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "sim/bench.h"

namespace weft {

struct EffectBenchOptions {
  double time_s = 0.5;            ///< simulated before anything is timed, so that contacts have begun
  std::uint32_t repetitions = 9;  ///< turns of each of the two, after one that warms up
  std::vector<std::string> only;  ///< names of effects; empty: all
  /// What runs `integrate`, as GpuSimulationOptions::kernel; where it does not fit, what runs unasked.
  std::string kernel;
  /// Particle·substeps, above which a turn is the first substeps of a frame, and its milliseconds those of a
  /// frame whose other substeps take as long as those after the first; and above which less than time_s is
  /// simulated.
  double turn_most = 1e7, warm_most = 2e8;
};

/// One side of a comparison.
struct EffectSide {
  Sample frame_ms;               ///< of a frame, by the device's timestamps; native: by the wall clock
  Sample processor_ms;           ///< of all threads; NaN where no processor computes
  std::string kernel;            ///< what runs `integrate`, and who decided
  std::uint64_t bytes = 0;       ///< allocated by the simulation
  std::uint64_t dispatches = 0;  ///< of a frame; native: steps of the plan
  std::uint32_t automatic = 0;   ///< substeps a frame that the scene asks for by itself
};

struct EffectRow {
  std::string effect;
  bool in_scene = false;      ///< else it was added and has nothing to do
  EffectSide with, without;   ///< with equal substeps: those that `with` asks for
  double cost = 0;            ///< median of the turns' (with − without)/without
  double cost_spread = 0;     ///< half the distance between the quartiles of that
  double processor_cost = 0;  ///< cost by processor_ms; NaN likewise
  /// Without it over the same in kernels that lack the effect's text, less one; NaN where it is no constant
  /// of theirs, or the program has none.
  double absent_cost = std::numeric_limits<double>::quiet_NaN();
  double absent_spread = 0;  ///< half the distance between the quartiles of that
  double toggle_ms = 0;  ///< making the other plan's simulation with the state carried over, pipelines known
  std::string left_out;  ///< why it was not measured; empty when it was
};

struct EffectBenchReport {
  std::string device, scene, solver, precision;
  std::uint32_t nx = 0, ny = 0;
  double time_s = 0;  ///< what was simulated before
  std::vector<EffectRow> rows;
};

/// @param note  told which effect is timed
/// @throws Error(Exit::no_device) when the device has no timestamps; Error(Exit::usage) for an unknown effect
EffectBenchReport bench_effects(gpu::Device&, const Scene&, const EffectBenchOptions&,
                                const std::function<void(const std::string&)>& note);

/// The same on the CPU's vector units, in as many threads as are the fastest while the scene is brought to
/// its state.
/// @throws Error(Exit::usage) when native does not run the scene, or for an unknown effect
EffectBenchReport bench_effects_on_native(const Scene&, const EffectBenchOptions&,
                                          const std::function<void(const std::string&)>& note);

}  // namespace weft
