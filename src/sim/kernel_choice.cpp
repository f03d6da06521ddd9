// Who decides which kernel runs: a name, the memory of an earlier trial, or a new one.
#include "sim/kernel_choice.h"

#include <algorithm>
#include <cstdlib>

#include "core/error.h"
#include "sim/kernel_memory.h"
#include "sim/kernel_search.h"

namespace weft {
namespace {

bool is_candidate(const gpu::Device& device, const Plan& plan, const Kernel& kernel) {
  return std::ranges::any_of(kernel_candidates(device, plan), [&](const KernelCandidate& candidate) {
    return candidate.kernel == kernel && candidate.unfit.empty();
  });
}

KernelChoice automatic(gpu::Device& device, const Model& model, const Plan& plan,
                       std::shared_ptr<GpuPipelines> pipelines, const std::filesystem::path& file,
                       bool may_try) {
  const std::vector<KernelCandidate> candidates = kernel_candidates(device, plan);
  if (candidates.size() == 1) return {candidates[0].kernel, "default", {}, {}};
  const std::string key = kernel_memory_key(plan);
  const auto remembered = file.empty() ? std::nullopt : remembered_kernel(file, key);
  if (remembered && is_candidate(device, plan, *remembered)) return {*remembered, "remembered", {}, {}};
  if (!may_try) return {untried_kernel(device, plan), "default", {}, {}};
  KernelSearch search(device, model, plan, std::move(pipelines), file);
  while (search.go_on()) {
  }
  return search.choice();
}

}  // namespace

double expected_work_s(const gpu::Device& device, const Plan& plan, double substeps) {
  const double ns = device.info().software ? 20.0 : 0.2;  // a particle·substep; docs/performance.md
  const Range& range = plan.steps.at(0).range;
  return substeps * range.x * range.y * ns * 1e-9;
}

KernelChoice choose_kernel(gpu::Device& device, const Model& model, const Plan& plan,
                           std::shared_ptr<GpuPipelines> pipelines, std::string name,
                           std::filesystem::path file, KernelTrial trial) {
  if (const char* wish = std::getenv("WEFT_KERNEL"); name.empty() && wish != nullptr) name = wish;
  if (!name.empty() && name != "auto") return {named_kernel(device, plan, name), "forced", {}, {}};
  if (file.empty()) file = kernel_memory_file(device);
  const bool may_try = trial == KernelTrial::allowed || (trial == KernelTrial::when_named && !name.empty());
  return automatic(device, model, plan, std::move(pipelines), file, may_try);
}

std::filesystem::path kernel_memory_file(gpu::Device& device) {
  const std::filesystem::path cache = device.pipeline_cache().file();
  if (cache.empty()) return {};
  return cache.parent_path() / ("kernels-" + cache.stem().string() + ".json");
}

bool is_worth_searching(gpu::Device& device, const Plan& plan, const KernelChoice& choice) {
  return choice.how == "default" && kernel_candidates(device, plan).size() > 1 &&
         !kernel_memory_file(device).empty();
}

std::string describe(const KernelChoice& choice) {
  std::string text = fmt::format("{} ({}", describe(choice.kernel), choice.how);
  for (std::size_t t = 0; t < choice.trial.size(); ++t)
    text += fmt::format("{}{} {:.3g}", t == 0 ? ": " : ", ", describe(choice.trial[t].kernel),
                        choice.trial[t].ns);
  return text + (choice.trial.empty() ? ")" : " ns)");
}

}  // namespace weft
