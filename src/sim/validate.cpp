// The device against the CPU reference: every pass by itself, then frames in lockstep.
#include "sim/validate.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "plan/spread_frame.h"
#include "plan/spread_words.h"
#include "sim/allowance.h"
#include "sim/gpu_simulation.h"
#include "sim/pass_runner.h"
#include "sim/poison.h"
#include "sim/probe_states.h"

namespace weft {
namespace {

std::string_view block_suffix(Block block) { return block == Block::frame_end ? " (frame end)" : ""; }

template <class T, class From>
HostBuffers<T> converted(const HostBuffers<From>& host) {
  HostBuffers<T> to;
  to.words = host.words;
  for (std::size_t b = 0; b < kBufferCount; ++b) to.vec4[b].assign(host.vec4[b].begin(), host.vec4[b].end());
  return to;
}

template <class T>
void swap_state(HostBuffers<T>& host) {
  std::swap(host[BufferId::position], host[BufferId::position_next]);
  std::swap(host[BufferId::velocity], host[BufferId::velocity_next]);
}

/// A step by the mirrors of both precisions, from the same floats: what float loses on it.
class FloatLoss {
 public:
  template <class T>
  FloatLoss(const PlanStep& step, const MirrorContext& context, const HostBuffers<T>& before)
      : float_(converted<float>(before)), double_(converted<double>(float_)) {
    step.pass->mirror_f32(context, float_);
    step.pass->mirror_f64(context, double_);
  }
  /// A step more, from where the mirrors have come to.
  void again(const PlanStep& step, const MirrorContext& context) {
    swap_state(float_);
    swap_state(double_);
    step.pass->mirror_f32(context, float_);
    step.pass->mirror_f64(context, double_);
  }
  Difference in(BufferId id) const { return difference(float_[id], double_[id]); }

 private:
  HostBuffers<float> float_;
  HostBuffers<double> double_;
};

void run_mirror(const PlanStep& step, const MirrorContext& context, HostBuffers<float>& buffers) {
  step.pass->mirror_f32(context, buffers);
}
void run_mirror(const PlanStep& step, const MirrorContext& context, HostBuffers<double>& buffers) {
  step.pass->mirror_f64(context, buffers);
}

/// Of a plan that computes in T.
template <class T>
class Validator {
 public:
  Validator(gpu::Device& device, const Model& model, const Solver& solver, const ValidationOptions& options)
      : device_(device),
        model_(model),
        solver_(solver),
        options_(options),
        plan_(compile_plan(model, solver, model.scene.solver.precision)) {
    if (const char* name = std::getenv("WEFT_PERTURB"); options_.perturb.empty() && name != nullptr)
      options_.perturb = name;
    report_.device = device.info().name;
    report_.scene = model.scene.title;
    report_.exact_required = device.info().software && !options_.assume_inexact;
    pipelines_ = std::make_shared<GpuPipelines>(device);
    held_ = static_cast<std::size_t>(std::ranges::count(model.relative_inverse_mass, 0.0));
  }

  ValidationReport run() {
    const Perturbation perturbation(options_.perturb, plan_);
    if (perturbation.active()) report_.perturbed = options_.perturb;
    check_passes(perturbation);
    check_lockstep();
    return std::move(report_);
  }

 private:
  void check_passes(const Perturbation& perturbation);
  void check_plan(const Perturbation& perturbation);
  struct Walk {  ///< through a frame
    const ProbeState& probe;
    std::vector<KickDrift> rows;
    HostBuffers<T> host;
  };
  struct KernelRunner {
    std::string suffix;  ///< of the check's name: ", kernel strip"; empty with the direct one
    Kernel kernel;
    std::unique_ptr<PassRunner> runner;
  };
  struct KernelRun {
    std::string check;  ///< "lockstep" with the direct kernel, else "lockstep, kernel strip"
    std::unique_ptr<Simulation> simulation;
  };
  std::vector<std::string> kernel_names() const {
    return options_.every_kernel ? fitting_kernel_names(device_, plan_) : std::vector<std::string>{"direct"};
  }
  void start_runners(const Perturbation& perturbation);
  void check_frame(const ProbeState& probe);
  void check_step(std::size_t step, std::uint32_t substep, Walk& walk);
  void size_outputs(std::size_t step, HostBuffers<T>& host) const;
  void check_several(const KernelRunner& with, const Walk& walk);
  void check_outputs(const std::string& check, const Walk& walk, const HostBuffers<T>& before,
                     PassResult<T>& result, HostBuffers<T>& expected, const std::optional<FloatLoss>& loss);
  void check_lockstep();
  void start_runs();
  void compare_states(const KernelRun& run, const std::string& name);

  gpu::Device& device_;
  const Model& model_;
  const Solver& solver_;
  ValidationOptions options_;
  Plan plan_;
  ValidationReport report_;
  std::size_t held_ = 0;                ///< pinned particles
  std::vector<KernelRunner> runners_;   ///< direct first, then every kind that fits
  std::vector<KernelRun> device_runs_;  ///< in lockstep, all these
  std::shared_ptr<GpuPipelines> pipelines_;
  std::unique_ptr<Simulation> mirror_run_, other_run_;  ///< in lockstep; other: float or double
};

/// The plan's own steps, and those of its frames in which the cloth stays spread out.
template <class T>
void Validator<T>::check_passes(const Perturbation& perturbation) {
  check_plan(perturbation);
  if (!plan_.spreads) return;
  const Plan whole = std::exchange(plan_, spread_frame(plan_, model_, 1));
  check_plan(perturbation);
  plan_ = whole;
}

template <class T>
void Validator<T>::check_plan(const Perturbation& perturbation) {
  start_runners(perturbation);
  for (const ProbeState& probe : probe_states(model_, solver_)) check_frame(probe);
  runners_.clear();
}

template <class T>
void Validator<T>::start_runners(const Perturbation& perturbation) {
  for (const std::string& name : kernel_names()) {
    const Kernel kernel = named_kernel(device_, plan_, name);
    runners_.push_back(
        {name == "direct" ? "" : ", kernel " + name, kernel,
         std::make_unique<PassRunner>(device_, model_, plan_, perturbation, kernel, pipelines_)});
  }
}

/// Whether the solver keeps more than positions and velocities from one substep to the next, so that the
/// frame's first substep differs from the others.
bool keeps_more(const Plan& plan) {
  return std::ranges::any_of(plan.buffers, [](const PlanBuffer& b) {
    return b.id > BufferId::normal && b.id < BufferId::draw_position;
  });
}

/// Walks through a frame whose state begins as the probe: its start, one substep or two, its end. The mirrors
/// lead, so that each step is checked on what the ones before it leave.
template <class T>
void Validator<T>::check_frame(const ProbeState& probe) {
  const std::uint32_t n = plan_.substeps, checked = std::min(n, keeps_more(plan_) ? 2u : 1u);
  Walk walk{.probe = probe,
            .rows = solver_.schedule(probe.state.time_s, model_.scene.solver.frame_s, n),
            .host = {}};
  walk.rows.resize(plan_.row_count());  // a closing row of zeros where the schedule has none
  size_buffers(plan_, model_, walk.host);
  for (const PlanBuffer& buffer : plan_.buffers)  // what no pass has written yet is the runner's to fill
    if (buffer.id != BufferId::built_position && buffer.id != BufferId::compensation)
      walk.host[buffer.id].clear();
  load_state(model_, probe.state, walk.host);
  if (plan_.tells_kicks) ask_for_spread(plan_, model_, walk.host);
  const auto check_block = [&](Block block, std::uint32_t substep) {
    for (std::size_t step = 0; step < plan_.steps.size(); ++step)
      if (plan_.steps[step].block == block) check_step(step, substep, walk);
  };
  check_block(Block::frame_start, 0);
  for (const KernelRunner& with : runners_)
    if (with.kernel.substeps > 1 && n > 1) check_several(with, walk);
  for (std::uint32_t k = 0; k < checked; ++k) check_block(Block::substep, k);
  check_block(Block::frame_end, n);
}

/// @param expected  what the mirror left, poison where it wrote nothing
/// @param loss      absent where the device must be exact
template <class T>
void Validator<T>::check_outputs(const std::string& check, const Walk& walk, const HostBuffers<T>& before,
                                 PassResult<T>& result, HostBuffers<T>& expected,
                                 const std::optional<FloatLoss>& loss) {
  for (const BufferId id : result.outputs) {
    ValidationRow row{.check = check, .state = walk.probe.name, .buffer = std::string(row_of(id).name)};
    restore_unwritten(id, before, result.buffers, expected);
    if (holds_words(id)) {
      judge_words(row, result.buffers.words_of(id), expected.words_of(id));
      report_.rows.push_back(std::move(row));
      continue;
    }
    std::optional<Allowance> allowed;
    if (loss) allowed = allowance<T>(loss->in(id), expected[id].size(), held_);
    give_verdict(row, difference(result.buffers[id], expected[id]), allowed);
    report_.rows.push_back(std::move(row));
  }
  ValidationRow others{.check = check, .state = walk.probe.name, .buffer = "all others"};
  others.ok = result.touched.empty();
  others.verdict = others.ok ? "untouched" : fmt::format("touched: {}", row_of(result.touched[0]).name);
  report_.rows.push_back(std::move(others));
}

/// Gives what the step writes a place: a pass that has nothing to do leaves it as it is.
template <class T>
void Validator<T>::size_outputs(std::size_t step, HostBuffers<T>& host) const {
  for (const PlanBuffer& buffer : plan_.buffers) {
    const auto use = runners_[0].runner->use_of(step, buffer.id);
    if (holds_vectors(buffer.id) && use.writes && !use.reads)
      host[buffer.id].resize(element_count(buffer.id, model_, plan_.row_count()));
  }
}

/// Runs one step on the device, by every kernel that has a form of its own of it, and by its mirror, all from
/// the walk's buffers; what the mirror leaves there is what the next step finds.
template <class T>
void Validator<T>::check_step(std::size_t step, std::uint32_t substep, Walk& walk) {
  const PlanStep& planned = plan_.steps[step];
  HostBuffers<T>& host = walk.host;
  const std::uint32_t row_index = plan_.table_row(planned, substep);
  size_outputs(step, host);
  const HostBuffers<T> before = host;
  std::vector<PassResult<T>> results;
  std::vector<const KernelRunner*> with;
  for (const KernelRunner& runner : runners_)
    if (with.empty() || has_own_form(runner.kernel, *planned.pass)) with.push_back(&runner);
  for (const KernelRunner* own : with) results.push_back(own->runner->run(step, host, walk.rows, row_index));
  const MirrorContext context{model_,    planned.constants, walk.rows[row_index],
                              row_index, planned.item,      kProbeSpeedAllowed_m_s};
  std::optional<FloatLoss> loss;
  if (!report_.exact_required) loss.emplace(planned, context, host);
  for (const BufferId id : results[0].outputs)
    if (!runners_[0].runner->use_of(step, id).reads) poison_mirror(id, host);
  run_mirror(planned, context, host);
  if (const auto settle = planned.pass->settle_order; settle != nullptr) {
    for (PassResult<T>& result : results) settle(result.buffers);
    settle(host);
  }
  const std::string check = std::string(planned.pass->name).append(block_suffix(planned.block));
  for (std::size_t r = 1; r < results.size(); ++r) {
    HostBuffers<T> expected = host;
    for (const BufferId id : results[r].outputs)
      if (with[r]->runner->use_of(step, id).reads) restore_poisoned(id, before, expected);
    check_outputs(check + with[r]->suffix, walk, before, results[r], expected, loss);
  }
  check_outputs(check, walk, before, results[0], host, loss);
  if (planned.pass->swaps_state) swap_state(host);
}

/// A dispatch of several substeps against as many runs of the mirror.
template <class T>
void Validator<T>::check_several(const KernelRunner& with, const Walk& walk) {
  std::size_t step = 0;
  while (plan_.steps[step].pass != &integrate || plan_.steps[step].block != Block::substep) ++step;
  const PlanStep& planned = plan_.steps[step];
  const std::uint32_t count = std::min(with.kernel.substeps, plan_.substeps);
  const std::uint32_t first_row = plan_.table_row(planned, 0);
  PassResult<T> result = with.runner->run(step, walk.host, walk.rows, first_row, count);
  HostBuffers<T> expected = walk.host;
  std::optional<FloatLoss> loss;
  for (std::uint32_t k = 0; k < count; ++k) {
    if (k > 0) swap_state(expected);
    const std::uint32_t row = first_row + k;
    const MirrorContext context{model_, planned.constants, walk.rows[row], row, planned.item};
    for (const BufferId id : {BufferId::position_next, BufferId::velocity_next}) {
      expected[id].resize(expected[BufferId::position].size());
      poison_mirror(id, expected);
    }
    if (!report_.exact_required && k == 0) loss.emplace(planned, context, expected);
    if (loss && k > 0) loss->again(planned, context);
    run_mirror(planned, context, expected);
  }
  check_outputs(fmt::format("integrate{}, {} substeps", with.suffix, count), walk, walk.host, result,
                expected, loss);
}

template <class T>
std::vector<glm::vec<4, T>> as_vec4(const std::vector<glm::dvec3>& vectors) {
  std::vector<glm::vec<4, T>> out;
  out.reserve(vectors.size());
  for (const glm::dvec3& v : vectors) out.emplace_back(glm::vec<3, T>(v), T(0));
  return out;
}

template <class T>
void Validator<T>::compare_states(const KernelRun& run, const std::string& name) {
  const State got = run.simulation->read(), expected = mirror_run_->read();
  const State other = other_run_ ? other_run_->read() : State{};
  const State& in_float = plan_.in_double() ? other : expected;
  const State& in_double = plan_.in_double() ? expected : other;
  const auto compare = [&](BufferId id, const auto member) {
    ValidationRow row{.check = run.check, .state = name, .buffer = std::string(row_of(id).name)};
    const auto reference = as_vec4<T>(expected.*member);
    std::optional<Allowance> allowed;
    if (other_run_) {
      const Difference lost =
          difference(as_vec4<float>(in_float.*member), as_vec4<double>(in_double.*member));
      allowed = allowance<T>(lost, reference.size(), held_);
      allowed->bias = allowed->max_abs;  // errors of many steps are no longer independent
    }
    give_verdict(row, difference(as_vec4<T>(got.*member), reference), allowed);
    report_.rows.push_back(std::move(row));
  };
  compare(BufferId::position, &State::position);
  compare(BufferId::velocity, &State::velocity);
}

/// Every kind of kernel that fits the device, and the references.
template <class T>
void Validator<T>::start_runs() {
  for (const std::string& kernel : kernel_names())
    device_runs_.push_back(
        {kernel == "direct" ? "lockstep" : "lockstep, kernel " + kernel,
         GpuSimulation::create(device_, model_, solver_,
                               {.perturb = options_.perturb, .pipelines = pipelines_, .kernel = kernel})});
  mirror_run_ = make_cpu_simulation(model_, solver_, plan_.precision);
  if (!report_.exact_required)
    other_run_ = make_cpu_simulation(model_, solver_, plan_.in_double() ? "f32" : "f64");
}

template <class T>
void Validator<T>::check_lockstep() {
  start_runs();
  const std::uint32_t n = plan_.substeps;
  const double frame_s = model_.scene.solver.frame_s;
  const auto advance = [&](std::uint32_t substeps) {
    for (const KernelRun& run : device_runs_) run.simulation->advance(frame_s * substeps / n, substeps);
    for (Simulation* simulation : {mirror_run_.get(), other_run_.get()})
      if (simulation != nullptr) simulation->advance(frame_s * substeps / n, substeps);
  };
  const auto compare = [&](const std::string& name) {
    for (const KernelRun& run : device_runs_) compare_states(run, name);
  };
  for (std::uint32_t left = options_.lockstep_substeps; left > 0;) {
    const std::uint32_t substeps = std::min(left, n);
    advance(substeps);
    left -= substeps;
  }
  if (options_.lockstep_substeps > 0) compare(fmt::format("{} substeps", options_.lockstep_substeps));
  for (std::uint32_t frame = 0; frame < options_.lockstep_frames; ++frame) advance(n);
  if (options_.lockstep_frames > 0) compare(fmt::format("{} frames on", options_.lockstep_frames));
}

}  // namespace

bool ValidationReport::ok() const {
  return std::ranges::all_of(rows, [](const ValidationRow& row) { return row.ok; });
}

ValidationReport validate(gpu::Device& device, const Model& model, const Solver& solver,
                          const ValidationOptions& options) {
  if (model.scene.solver.precision == "f64") return Validator<double>(device, model, solver, options).run();
  return Validator<float>(device, model, solver, options).run();
}

}  // namespace weft
