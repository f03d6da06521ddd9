// Runs single steps of a plan on the device from given buffers, for checking a pass by itself.
#pragma once
#include <map>
#include <vector>

#include "passes/host_buffers.h"
#include "sim/gpu_program.h"
#include "sim/perturb.h"

namespace weft {

/// A quiet NaN that no computation yields, in every word that a pass is to write.
inline constexpr std::uint32_t kPoison = 0x7fd15ea5u;

/// What a single dispatch left behind.
struct PassResult {
  std::vector<BufferId> outputs;  ///< what the pass writes, from its SPIR-V
  HostBuffers<float> buffers;     ///< every buffer of the plan except the tables
  std::vector<BufferId> touched;  ///< buffers it should have left alone and did not
};

class PassRunner {
 public:
  PassRunner(gpu::Device&, const Model&, const Plan&, const Perturbation&);
  /// Runs plan step `step` once on row `row_index` of `rows`. `input` gives what the pass reads; what it only
  /// writes is filled with kPoison first, what it does not touch and `input` does not have with a pattern.
  PassResult run(std::size_t step, const HostBuffers<float>& input, std::span<const KickDrift> rows,
                 std::uint32_t row_index);

  struct Use {
    bool reads = false, writes = false;
  };
  /// What the step's shader does with a buffer.
  Use use_of(std::size_t step, BufferId id) const;

 private:
  using Bytes = std::vector<std::byte>;
  std::map<BufferId, Bytes> contents(std::size_t step, const HostBuffers<float>& input,
                                     std::span<const KickDrift> rows) const;
  gpu::Device& device_;
  const Model& model_;
  Plan plan_;
  const Perturbation& perturbation_;
  GpuBuffers buffers_;
  GpuProgram program_;
};

}  // namespace weft
