// The trial of the kernels, and who decides: a name, the memory of an earlier trial, or a new one.
#include "sim/kernel_choice.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "core/error.h"
#include "gpu/commands.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "sim/gpu_program.h"
#include "sim/kernel_memory.h"

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTrial_s = 0.5;  // after which no candidate is begun

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Runs candidates over the first substeps of the model, in buffers of its own.
class Trial {
 public:
  Trial(gpu::Device& device, const Model& model, const Plan& plan, std::shared_ptr<GpuPipelines> pipelines)
      : device_(device), model_(model), plan_(plan), pipelines_(std::move(pipelines)) {
    for (std::size_t s = 0; s < plan.steps.size(); ++s)
      if (plan.steps[s].pass == &integrate && plan.steps[s].block == Block::substep) step_ = s;
    particles_ = model.grid.count();
    substeps_ = std::min(particles_ > (1u << 16) ? 4u : 24u, plan.substeps);
  }

  /// Nanoseconds a particle·substep, by the wall clock: submits and barriers belong to it.
  double time_ns(const Kernel& kernel) {
    GpuBuffers buffers(device_, model_, plan_, kernel);
    fill(buffers);
    const GpuProgram program(device_, plan_, buffers, pipelines_, kernel);
    gpu::Commands commands(device_, "kernel trial", gpu::Reuse::many);
    commands.record([&](VkCommandBuffer recorded) { record(recorded, program); });
    device_.wait(device_.submit(commands.handle()));  // compiles on some drivers
    double best_s = 1e9;
    for (int run = 0; run < 3; ++run) {
      const Clock::time_point start = Clock::now();
      device_.wait(device_.submit(commands.handle()));
      best_s = std::min(best_s, seconds_since(start));
    }
    return best_s * 1e9 / (double(particles_) * substeps_);
  }

 private:
  void fill(GpuBuffers& buffers) const {
    HostBuffers<float> host;
    load_state(model_, start_state(model_), host);
    const shared::Params params = make_params(model_);
    std::vector<shared::vec4> table;
    fill_substep_rows(model_, plan_.solver->schedule(0, model_.scene.solver.frame_s, plan_.substeps), table);
    buffers.at(BufferId::params).write(std::as_bytes(std::span(&params, 1)));
    buffers.at(BufferId::substeps).write(std::as_bytes(std::span(table)));
    for (const BufferId id : {BufferId::position, BufferId::velocity})
      buffers.at(id).write(std::as_bytes(std::span(host[id])));
  }
  void record(VkCommandBuffer commands, const GpuProgram& program) const {
    gpu::Recorder recorder(device_, commands);
    Parity parity = 0;
    for (std::uint32_t row = 0; row < substeps_; parity ^= 1u) {
      const std::uint32_t count = std::min(program.kernel().substeps, substeps_ - row);
      program.dispatch(recorder, step_, parity, 0, row, count);
      row += count;
    }
    recorder.finish();
  }

  gpu::Device& device_;
  const Model& model_;
  const Plan& plan_;
  std::shared_ptr<GpuPipelines> pipelines_;
  std::size_t step_ = 0;
  std::uint32_t particles_ = 0, substeps_ = 0;
};

KernelChoice tried(gpu::Device& device, const Model& model, const Plan& plan,
                   std::shared_ptr<GpuPipelines> pipelines) {
  KernelChoice choice{.kernel = direct_kernel(device, plan), .how = "trial", .trial = {}, .out = {}};
  const Clock::time_point start = Clock::now();
  Trial trial(device, model, plan, std::move(pipelines));
  for (const KernelCandidate& candidate : kernel_candidates(device, plan)) {
    if (!candidate.unfit.empty())
      choice.out.push_back(candidate);
    else if (choice.trial.empty() || seconds_since(start) < kTrial_s)
      choice.trial.push_back({candidate.kernel, trial.time_ns(candidate.kernel)});
    else
      choice.out.push_back({candidate.kernel, "the trial's time was up"});
  }
  choice.kernel = std::ranges::min_element(choice.trial, {}, &TimedKernel::ns)->kernel;
  return choice;
}

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
  require_fits(device, model, plan);
  if (!pipelines) pipelines = std::make_shared<GpuPipelines>(device);
  KernelChoice choice = tried(device, model, plan, std::move(pipelines));
  if (!file.empty()) remember_kernel(file, key, choice.kernel);
  return choice;
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

std::string describe(const KernelChoice& choice) {
  std::string text = fmt::format("{} ({}", describe(choice.kernel), choice.how);
  for (std::size_t t = 0; t < choice.trial.size(); ++t)
    text += fmt::format("{}{} {:.3g}", t == 0 ? ": " : ", ", describe(choice.trial[t].kernel),
                        choice.trial[t].ns);
  return text + (choice.trial.empty() ? ")" : " ns)");
}

}  // namespace weft
