// Which kernel runs a plan on a device: forced by name, remembered, or found by a short trial.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "model/model.h"
#include "sim/gpu_pipelines.h"
#include "sim/kernels.h"

namespace weft {

struct TimedKernel {
  Kernel kernel;
  double ns = 0;  ///< a particle·substep
};

struct KernelChoice {
  Kernel kernel;
  std::string how;                   ///< "default", "forced", "remembered" or "trial"
  std::vector<TimedKernel> trial;    ///< what was timed, when how is "trial"
  std::vector<KernelCandidate> out;  ///< what could not be tried, with the reason
};

/// Whether "auto", where nothing is remembered, may time the candidates first: always, only when it was asked
/// for by that name, or never (a window must not stall).
enum class KernelTrial { allowed, when_named, never };

/// A trial takes a second or two; work that is done in less is better begun at once.
inline constexpr double kWorthTrying_s = 2.0;

/// About how long `substeps` substeps take on the device [s], before anything was measured.
double expected_work_s(const gpu::Device&, const Plan&, double substeps);

/// @param name  one of kernel_names(); empty: the environment's WEFT_KERNEL, else "auto". All kernels end in
///              the same bits, so the choice changes no result
/// @param trial  where none is made, what is not remembered is untried_kernel()
/// "auto" takes what an earlier trial of this device, driver, size and set of constants found, kept beside
/// the pipeline cache; without one it times the candidates on buffers of its own and keeps the result. The
/// trial starts no candidate after half a second, so that slow compilers do not hold up a start.
/// @param file  where trials are kept; empty: kernel_memory_file()
/// @throws Error(Exit::usage) for an unknown name or a kernel that does not fit
KernelChoice choose_kernel(gpu::Device&, const Model&, const Plan&, std::shared_ptr<GpuPipelines>,
                           std::string name = {}, std::filesystem::path file = {},
                           KernelTrial trial = KernelTrial::allowed);

/// Beside the pipeline cache, one a device and driver; empty where there is no cache folder.
std::filesystem::path kernel_memory_file(gpu::Device&);

/// Whether a trial may still find a faster kernel than the choice, and can be remembered.
bool is_worth_searching(gpu::Device&, const Plan&, const KernelChoice&);

/// "strip 4x16 (trial: strip 4x16 6.1, texel 1x16 11.2 ns)": for people.
std::string describe(const KernelChoice&);

}  // namespace weft
