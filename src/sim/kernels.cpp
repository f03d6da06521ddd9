// Which kernels there are for `integrate`, and which of them a device can run.
#include "sim/kernels.h"

#include <algorithm>
#include <array>
#include <thread>

#include "core/error.h"
#include "passes/integrate.h"
#include "passes/passes.h"
#include "plan/buffers.h"
#include "sim/frame_commands.h"

namespace weft {
namespace {

using namespace std::string_view_literals;

constexpr std::array kNames = {"direct"sv, "texel"sv, "strip"sv, "steal"sv, "bands"sv, "auto"sv};
constexpr std::uint32_t kParticle = 2;        // vec4s: position and velocity
constexpr std::uint32_t kMostTurns = 50'000;  // of all loops of an invocation; llvmpipe stops them at 65 535
constexpr std::uint64_t kMostForBands = 1u
                                        << 17;  // particles; beyond, a dispatch costs little beside its work

/// The step that the kernels are for: they read texels, which are floats.
const PlanStep* substep_integrate(const Plan& plan) {
  if (plan.in_double()) return nullptr;
  for (const PlanStep& step : plan.steps)
    if (step.pass == &integrate && step.block == Block::substep) return &step;
  return nullptr;
}

/// Why there is no such step.
std::string no_integrate(const Plan& plan) {
  return plan.in_double() ? "it computes in float, and this plan is in double (f64)"
                          : "the plan has no pass integrate";
}

std::string texels_unfit(const gpu::Device& device, std::uint64_t texels) {
  const std::uint64_t most = device.limits().maxTexelBufferElements;
  if (texels <= most) return {};
  return fmt::format("it reads {} texels of one buffer; {} allows {}", texels, device.info().name, most);
}

/// Tiles of a steal kernel: what a subgroup takes at once.
std::uint32_t tiles_of(const gpu::Device& device, const Range& range, std::uint32_t columns,
                       std::uint32_t rows) {
  const std::uint32_t wide = columns * std::max(device.info().subgroup_size, 1u);
  return (range.x + wide - 1) / wide * ((range.y + rows - 1) / rows);
}

/// Several queues a thread where there are tiles enough: a workgroup takes at most twice its share, so that a
/// fast thread's later ones can take what a slow thread leaves. No invocation may come near kMostTurns.
Kernel steal_kernel(const gpu::Device& device, const PlanStep& step, std::uint32_t rows) {
  constexpr std::uint32_t kColumns = 4, kQueuesPerThread = 4;
  const std::uint32_t threads = std::max(std::thread::hardware_concurrency(), 1u);
  const std::uint32_t tiles = tiles_of(device, step.range, kColumns, rows);
  const std::uint32_t wanted = tiles < 2 * kQueuesPerThread * threads ? threads : kQueuesPerThread * threads;
  // Where spheres are looped over: at worst every particle of a tile, and all spheres for each.
  const bool looped = step.constants[kHasSpheres].value >= kSpheresLooped;
  const std::uint64_t turns = rows + 4 + (looped ? rows * kColumns * (1 + shared::kMaxSpheres) : 0);
  const auto needed = static_cast<std::uint32_t>(2 * tiles * turns / kMostTurns + 1);
  return {.kind = KernelKind::steal,
          .columns = kColumns,
          .rows = rows,
          .queues = std::max(std::min(wanted, tiles), needed)};
}

std::string steal_unfit(const gpu::Device& device) {
  const gpu::DeviceInfo& info = device.info();
  if (!info.software) return fmt::format("it evens out a software device's threads; {} is none", info.name);
  if (!info.subgroup_ballot) return fmt::format("{} has no subgroup ballot in compute shaders", info.name);
  return {};
}

std::string bands_unfit(const gpu::Device& device, const Plan& plan, const Kernel& kernel) {
  const PlanStep& step = *substep_integrate(plan);
  const auto in_block = std::ranges::count(plan.steps, Block::substep, &PlanStep::block);
  if (in_block != 1 || plan.solver->rows_per_substep != 1)
    return "a substep of this plan is more than one pass";
  const std::uint64_t particles = std::uint64_t{step.range.x} * step.range.y;
  if (particles > kMostForBands)
    return fmt::format("it is for at most {} particles; the cloth has {}", kMostForBands, particles);
  const std::uint64_t bytes = scratch_bytes(kernel, plan), range = device.limits().maxStorageBufferRange;
  if (bytes > range)
    return fmt::format("its scratch takes {} bytes; {} binds {}", bytes, device.info().name, range);
  return texels_unfit(device, bytes / 16);
}

std::string unfit(const gpu::Device& device, const Plan& plan, const Kernel& kernel) {
  if (kernel.kind == KernelKind::direct) return {};
  const PlanStep* step = substep_integrate(plan);
  if (step == nullptr) return no_integrate(plan);
  if (plan.sheet_rows != 0 && kernel.kind != KernelKind::texel)
    return "it is for one cloth; the scene has several";
  std::string reason = texels_unfit(device, std::uint64_t{step->range.x} * step->range.y);
  if (reason.empty() && kernel.kind == KernelKind::steal) reason = steal_unfit(device);
  if (reason.empty() && kernel.kind == KernelKind::bands) reason = bands_unfit(device, plan, kernel);
  return reason;
}

}  // namespace

std::string describe(const Kernel& k) {
  const std::string_view name = kNames.at(static_cast<std::size_t>(k.kind));
  if (k.kind == KernelKind::steal)
    return fmt::format("{} {}x{} from {} queues", name, k.columns, k.rows, k.queues);
  if (k.kind != KernelKind::bands) return fmt::format("{} {}x{}", name, k.columns, k.rows);
  return fmt::format("{} {}x{}, {} substeps a dispatch", name, k.bands, k.columns, k.substeps);
}

bool has_own_form(const Kernel& kernel, const Pass& pass) {
  return &pass == &integrate || (pass.takes_texels && kernel.kind == KernelKind::texel);
}

std::uint32_t march_rows(const gpu::Device& device, std::uint32_t rows) {
  return device.info().software ? std::clamp(rows / 16, 4u, 16u) : 1;
}

std::span<const std::string_view> kernel_names() { return kNames; }

Kernel direct_kernel(const gpu::Device& device, const Plan& plan) {
  auto marching = std::ranges::find_if(plan.steps, [](const PlanStep& s) { return s.pass->marches; });
  if (marching == plan.steps.end()) marching = plan.steps.begin();
  return {.kind = KernelKind::direct, .rows = march_rows(device, marching->range.y)};
}

std::vector<KernelCandidate> kernel_candidates(const gpu::Device& device, const Plan& plan) {
  const Kernel direct = direct_kernel(device, plan);
  std::vector<Kernel> kernels{direct};
  if (const PlanStep* step = substep_integrate(plan); step != nullptr) {
    kernels = {steal_kernel(device, *step, 16),
               {.kind = KernelKind::strip, .columns = 4, .rows = 16},
               {.kind = KernelKind::bands, .columns = 4, .rows = 16, .substeps = 4, .bands = 4},
               steal_kernel(device, *step, step->range.y < 192 ? 8 : 32),
               {.kind = KernelKind::texel, .rows = direct.rows},
               direct,
               {.kind = KernelKind::strip, .columns = 4, .rows = 32},
               {.kind = KernelKind::strip, .columns = 8, .rows = 16},
               {.kind = KernelKind::strip, .columns = 8, .rows = 32}};
    if (!device.info().software) std::ranges::rotate(kernels, kernels.begin() + 4);  // GPUs have caches
  }
  std::vector<KernelCandidate> candidates;
  for (const Kernel& kernel : kernels) candidates.push_back({kernel, unfit(device, plan, kernel)});
  return candidates;
}

Kernel untried_kernel(const gpu::Device& device, const Plan& plan) {
  if (device.info().software)
    for (const KernelCandidate& candidate : kernel_candidates(device, plan))
      if (candidate.kernel.kind == KernelKind::texel && candidate.unfit.empty()) return candidate.kernel;
  return direct_kernel(device, plan);
}

std::vector<std::string> fitting_kernel_names(const gpu::Device& device, const Plan& plan) {
  std::vector<std::string> names{"direct"};
  for (const KernelCandidate& candidate : kernel_candidates(device, plan)) {
    const std::string name(kNames.at(static_cast<std::size_t>(candidate.kernel.kind)));
    if (candidate.unfit.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

Kernel named_kernel(const gpu::Device& device, const Plan& plan, const std::string& name) {
  const auto known = std::ranges::find(kNames, name);
  if (known == kNames.end() || name == "auto")
    throw error(Exit::usage, "kernel is \"{}\"; it must be direct, texel, strip, steal, bands or auto", name);
  std::string reason = no_integrate(plan);
  for (const KernelCandidate& candidate : kernel_candidates(device, plan)) {
    if (candidate.kernel.kind != static_cast<KernelKind>(known - kNames.begin())) continue;
    if (candidate.unfit.empty()) return candidate.kernel;
    reason = candidate.unfit;
  }
  throw error(Exit::usage, "kernel {} does not fit: {}; use auto or direct", name, reason);
}

std::optional<KernelScratch> scratch_of(const Kernel& kernel, const Plan& plan) {
  constexpr std::uint64_t kHeadBytes = 64;  // a queue's: a cache line (integrate_steal.comp)
  if (kernel.kind == KernelKind::steal)
    return KernelScratch{BufferId::queue_heads, (kernel.queues + std::uint64_t{1}) * kHeadBytes};
  if (kernel.kind != KernelKind::bands) return {};
  const Range& range = substep_integrate(plan)->range;
  const std::uint64_t band_rows = (range.y + kernel.bands - 1) / kernel.bands;
  const std::uint64_t rows = band_rows + 4 * (kernel.substeps - 1);  // two a side and later substep
  return KernelScratch{BufferId::band_scratch, 2 * kernel.bands * rows * range.x * kParticle * 16};  // halves
}

std::uint64_t scratch_bytes(const Kernel& kernel, const Plan& plan) {
  const std::optional<KernelScratch> scratch = scratch_of(kernel, plan);
  return scratch ? scratch->bytes : 0;
}

std::uint64_t dispatches_with(const Kernel& kernel, const Plan& plan, std::uint32_t substeps) {
  return DispatchOrder(plan, substeps, kernel.substeps).count();
}

}  // namespace weft
