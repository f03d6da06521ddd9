// The same substeps on every backend by turns: vector kernels, Vulkan device, reference, in wall time.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "scene/scene.h"

namespace weft {

struct BackendBenchOptions {
  std::vector<std::uint32_t> resolutions{64, 128, 256};
  std::uint32_t repetitions = 7;
  double repetition_s = 0.1;  ///< about how long one turn of one backend takes; two substeps at least
  std::string kernel;  ///< of the Vulkan device; empty: auto, the fastest by an earlier or a short trial
};

/// One backend on one size.
struct BackendRow {
  std::string backend;                        ///< "native (AVX-512, 4 threads)"
  std::string kernel;                         ///< that the Vulkan device ran; empty elsewhere
  bool beside_busy = false;                   ///< while every core also ran a neighbour that computes
  std::uint32_t nx = 0, ny = 0, threads = 0;  ///< threads: the most; 0 where the backend does not say
  std::uint32_t substeps = 0;                 ///< a frame, automatic
  double ns_best = 0, ns_median = 0;          ///< wall time a particle·substep
  double frame_ms = 0;                        ///< of a whole frame at ns_best
  /// What the pairs' divisions and square roots alone would take on as many cores as the threads may have,
  /// measured in the same run, over what the sweep takes. Absent where the backend is not native, where cores
  /// are busy and in XPBD, whose springs divide otherwise.
  std::optional<double> divider_share;
};

struct BackendBenchReport {
  std::string scene, solver;
  std::uint32_t cores = 0, repetitions = 0;
  double root_and_division_ns = 0;  ///< of one float on one core
  std::vector<BackendRow> rows;
};

/// Times native by trial, in one thread, in exactly twice as many threads as there are cores, and the first
/// two again while each core runs another thread that computes; the Vulkan device with its fastest kernel,
/// and the reference. Everybody takes turns, so that what else the machine does falls on all alike; the best
/// turn tells what the machine can, the median what it did.
/// @param device  null: without it
/// @throws Error(Exit::usage) when native does not run the scene's solver and precision
BackendBenchReport bench_backends(gpu::Device* device, const Scene&, const BackendBenchOptions& = {});

}  // namespace weft
