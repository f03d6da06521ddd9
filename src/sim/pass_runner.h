// Runs single steps of a plan on the device from given buffers, for checking a pass by itself.
#pragma once
#include <bit>
#include <map>
#include <vector>

#include "passes/host_buffers.h"
#include "sim/device_data.h"
#include "sim/gpu_program.h"
#include "sim/perturb.h"

namespace weft {

/// What stands in everything that a pass is to write: a word, and quiet NaNs that no computation yields.
inline constexpr std::uint32_t kPoison = 0x7fd15ea5u;
inline constexpr std::uint64_t kPoison64 = 0x7ff95ea57fd15ea5u;
template <class T>
constexpr T poison() {
  if constexpr (sizeof(T) == sizeof kPoison)
    return std::bit_cast<T>(kPoison);
  else
    return std::bit_cast<T>(kPoison64);
}

/// What the cloth's mean square speed may be where single passes are checked: some probe states exceed it.
inline constexpr double kProbeSpeedAllowed_m_s = 2.0;

/// What a single dispatch left behind, of a plan that computes in T.
template <class T>
struct PassResult {
  std::vector<BufferId> outputs;  ///< what the pass writes, from its SPIR-V
  HostBuffers<T> buffers;         ///< every buffer of the plan except the tables
  std::vector<BufferId> touched;  ///< buffers it should have left alone, or as they were, and did not
};

class PassRunner {
 public:
  /// @param kernel     that runs `integrate`; absent: direct_kernel()
  /// @param pipelines  shared with other runners; null: its own
  PassRunner(gpu::Device&, const Model&, const Plan&, const Perturbation&,
             const std::optional<Kernel>& kernel = {}, std::shared_ptr<GpuPipelines> pipelines = nullptr);
  /// Runs plan step `step` once on row `row_index` of `rows`. `input` gives what the pass reads; what it only
  /// writes is filled with poison first, what it does not touch and `input` does not have with a pattern.
  /// T is what the plan computes in.
  /// @param substeps  that the one dispatch takes, at most the kernel's
  template <class T>
  PassResult<T> run(std::size_t step, const HostBuffers<T>& input, std::span<const KickDrift> rows,
                    std::uint32_t row_index, std::uint32_t substeps = 1);

  struct Use {
    bool reads = false, writes = false;
  };
  /// What the step's shader does with a buffer.
  Use use_of(std::size_t step, BufferId id) const;

 private:
  template <class T>
  std::map<BufferId, Bytes> contents(std::size_t step, const HostBuffers<T>& input,
                                     std::span<const KickDrift> rows) const;
  /// Whether the kernel's queues are empty again, as every dispatch must leave them.
  bool queues_settled();
  gpu::Device& device_;
  const Model& model_;
  Plan plan_;
  const Perturbation& perturbation_;
  GpuBuffers buffers_;
  GpuProgram program_;
};

}  // namespace weft
