// Candidates on buffers of their own, timed by the wall clock.
#include "sim/kernel_search.h"

#include <algorithm>
#include <chrono>

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

}  // namespace

/// Runs candidates over the first substeps of the model, in buffers of its own.
class KernelSearch::Trial {
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

KernelSearch::KernelSearch(gpu::Device& device, const Model& model, const Plan& plan,
                           std::shared_ptr<GpuPipelines> pipelines, std::filesystem::path file)
    : model_(model), plan_(plan), file_(std::move(file)) {
  require_fits(device, model, plan);
  choice_ = {.kernel = direct_kernel(device, plan), .how = "trial", .trial = {}, .out = {}};
  for (const KernelCandidate& candidate : kernel_candidates(device, plan))
    if (candidate.unfit.empty())
      candidates_.push_back(candidate.kernel);
    else
      choice_.out.push_back(candidate);
  if (!pipelines) pipelines = std::make_shared<GpuPipelines>(device);
  trial_ = std::make_unique<Trial>(device, model_, plan_, std::move(pipelines));
}

KernelSearch::~KernelSearch() = default;

const Kernel* KernelSearch::next() const {
  return next_ < candidates_.size() && (choice_.trial.empty() || spent_s_ < kTrial_s) ? &candidates_[next_]
                                                                                      : nullptr;
}

bool KernelSearch::go_on() {
  if (const Kernel* candidate = next()) {
    const Clock::time_point start = Clock::now();
    choice_.trial.push_back({*candidate, trial_->time_ns(*candidate)});
    spent_s_ += seconds_since(start);
    ++next_;
    if (next() == nullptr) settle();
  }
  return next() != nullptr;
}

void KernelSearch::settle() {
  for (; next_ < candidates_.size(); ++next_)
    choice_.out.push_back({candidates_[next_], "the trial's time was up"});
  choice_.kernel = std::ranges::min_element(choice_.trial, {}, &TimedKernel::ns)->kernel;
  if (!file_.empty()) remember_kernel(file_, kernel_memory_key(plan_), choice_.kernel);
}

}  // namespace weft
