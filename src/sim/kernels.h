// The kernels that can run the fused pass `integrate` on a device. They end in the same bits
// (docs/float-form.md) and differ in speed; which one runs is the device's choice and no part of the plan.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/device.h"
#include "plan/plan.h"

namespace weft {

enum class KernelKind {
  direct,  ///< gathers from storage buffers
  texel,   ///< the same through texel buffers
  strip,   ///< strips of columns, marched down, each spring inside once; texel buffers
  steal,   ///< strips that workgroups take from queues, their own first: no thread waits for a slower one
  bands,   ///< strips, several substeps a dispatch on bands of rows with recomputed halo
};

struct Kernel {
  KernelKind kind = KernelKind::direct;
  std::uint32_t columns = 1;   ///< of particles an invocation takes
  std::uint32_t rows = 1;      ///< of particles an invocation takes; with bands, in a dispatch of one substep
  std::uint32_t substeps = 1;  ///< at most in one dispatch
  std::uint32_t bands = 0;     ///< workgroups that share the rows; 0 unless kind is bands
  std::uint32_t queues = 0;    ///< workgroups, each with a queue of strips; 0 unless kind is steal
  bool operator==(const Kernel&) const = default;
};

/// "strip 4x16", "bands 4x4, 4 substeps a dispatch".
std::string describe(const Kernel&);

/// What may be asked for: "direct", "texel", "strip", "steal", "bands", or "auto" (sim/kernel_choice.h).
std::span<const std::string_view> kernel_names();

/// A kernel and why the device or the cloth cannot have it; empty when it can.
struct KernelCandidate {
  Kernel kernel;
  std::string unfit;
};

/// Every kernel worth trying, most promising first. Plans without `integrate` have only `direct`.
std::vector<KernelCandidate> kernel_candidates(const gpu::Device&, const Plan&);

/// The names of the kinds that fit; direct is the first.
std::vector<std::string> fitting_kernel_names(const gpu::Device&, const Plan&);

/// The kernel that needs nothing of the device.
Kernel direct_kernel(const gpu::Device&, const Plan&);

/// Whether a kernel runs a pass otherwise than the direct one does. Passes that take texels do so with all
/// others; `texel` stands for them.
bool has_own_form(const Kernel&, const Pass&);

/// Rows that an invocation of a marching pass over so many takes: marching saves loads and coefficients,
/// which is what a software device's time goes to, and keeps at least about 16 rows of workgroups for its
/// threads. A GPU needs the invocations.
std::uint32_t march_rows(const gpu::Device&, std::uint32_t rows);

/// What runs where nothing is asked for and no trial was made: on a software device `texel`, which its driver
/// compiles in half a second, where faster kernels take five (docs/performance.md); elsewhere the direct one.
Kernel untried_kernel(const gpu::Device&, const Plan&);

/// The first candidate of that kind.
/// @throws Error(Exit::usage) for an unknown name, or a kernel that does not fit: why, and what does
Kernel named_kernel(const gpu::Device&, const Plan&, const std::string& name);

/// What a kernel needs beside the plan's buffers: bands and steal only.
struct KernelScratch {
  BufferId id;
  std::uint64_t bytes;
};
std::optional<KernelScratch> scratch_of(const Kernel&, const Plan&);
std::uint64_t scratch_bytes(const Kernel&, const Plan&);  ///< 0 without one

/// Dispatches of a frame of `substeps` substeps: the plan's, with the substep block divided by what the
/// kernel takes into one dispatch, rounded up.
std::uint64_t dispatches_with(const Kernel&, const Plan&, std::uint32_t substeps);

}  // namespace weft
