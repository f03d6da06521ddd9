// What the device needs for a substep, in GPU time, against the bandwidth it copies with.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "plan/plan.h"
#include "scene/scene.h"

namespace weft {

struct BenchOptions {
  std::vector<std::uint32_t> resolutions{64, 128, 256, 512, 1024};
  std::uint32_t repetitions = 7;
  double repetition_s = 0.1;    ///< about how long one repetition of one kernel takes
  bool without_damping = true;  ///< also time every size with material.damping = 0
  std::string kernel;           ///< one of kernel_names(), or "all"; empty: WEFT_KERNEL, else auto
};

/// Median of the repetitions and half the distance between the quartiles.
struct Sample {
  double median = 0, spread = 0;
};

Sample sample_of(std::vector<double> values);

struct CopyBandwidth {
  Sample command_gb_s;  ///< vkCmdCopyBuffer, bytes read plus bytes written
  Sample shader_gb_s;   ///< a compute shader copying vec4s
  std::uint64_t buffer_bytes = 0;
  double best_gb_s() const;
  std::string best() const;  ///< "command" or "shader"
};

struct BenchPass {
  std::string pass;
  Sample ms;  ///< of one substep, or once at the frame's end
};

struct BenchRow {
  std::uint32_t nx = 0, ny = 0;
  bool damping = false;
  std::string kernel;            ///< what ran `integrate` and who decided: "strip 4x16 (remembered)"
  std::uint32_t substeps = 0;    ///< a frame, automatic
  std::uint32_t dispatches = 0;  ///< of `integrate` in a repetition
  Sample ns_per_particle_substep;
  double particle_substeps_per_s = 0;
  double gb_s = 0;          ///< counting bytes_per_particle_substep()
  double share_moved = 0;   ///< gb_s over what the copy of the same run moved: bytes read plus bytes written
  double share_copied = 0;  ///< gb_s over what it copied: half of that
  std::uint64_t bytes = 0;  ///< of all buffers
  std::vector<BenchPass> passes;
};

struct BenchReport {
  std::string device, driver, scene, solver, precision;
  std::uint32_t repetitions = 0;
  CopyBandwidth copy;
  std::vector<BenchRow> rows;
};

/// Bytes a particle·substep must move at least: position and velocity, read and written once.
double bytes_per_particle_substep(const Plan&);

/// Times the scene's plan at each resolution, with and without damping; copies and kernels take turns, so
/// that their ratio belongs to one state of the machine. Sizes that do not fit the device are left out.
/// @throws Error(Exit::no_device) when the device has no timestamps.
BenchReport bench(gpu::Device&, const Scene&, const BenchOptions& = {});

/// The report as Google Benchmark prints it ("context", "benchmarks" with real_time in ns).
std::string to_benchmark_json(const BenchReport&);

}  // namespace weft
