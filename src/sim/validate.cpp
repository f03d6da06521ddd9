// The device against the CPU reference: every pass by itself, then frames in lockstep.
#include "sim/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

#include "core/error.h"
#include "passes/tables.h"
#include "sim/compare.h"
#include "sim/gpu_simulation.h"
#include "sim/pass_runner.h"
#include "sim/probe_states.h"

namespace weft {
namespace {

std::string_view block_suffix(Block block) { return block == Block::frame_end ? " (frame end)" : ""; }

/// How far a device that rounds otherwise may stray from the float mirror.
struct Allowance {
  double max_abs = 0, rms = 0, bias = 0;
};

/// @param lost   the float mirror against the double mirror: what rounding costs on this work
/// @param count  vectors in the buffer
/// @param held   pinned particles: the springs to them have no partner whose error cancels theirs, so that
/// the
///               mean may be off by the largest error at each
/// A division of 2.5 ulp and a root of 3 (Vulkan's limits) are some ten times the half ulp of the mirrors'.
/// Where float is exact by luck, an ulp of the largest number remains. Double loses on the same work what
/// float does, a rounding of 2^-53 for each of 2^-24.
template <class T>
Allowance allowance(const Difference& lost, std::size_t count, std::size_t held) {
  constexpr double kUlp = std::numeric_limits<float>::epsilon();
  constexpr double kScale = std::numeric_limits<T>::epsilon() / kUlp, kMax = 16 * kScale, kRms = 8 * kScale;
  const double n = static_cast<double>(count), ulp = kScale * kUlp * lost.magnitude;
  const double at_pins = kMax * lost.max_abs * static_cast<double>(held) / n;
  return {.max_abs = kMax * lost.max_abs + ulp,
          .rms = kRms * lost.rms + ulp,
          .bias = (kRms * lost.rms + ulp) / std::sqrt(n) + at_pins + kScale * lost.bias};
}

/// Fills in the verdict of a comparison from its difference; without an allowance it must be exact.
void judge(ValidationRow& row, const Difference& apart, const std::optional<Allowance>& allowed) {
  row.max_abs = apart.max_abs;
  row.rms = apart.rms;
  row.bias = apart.bias;
  row.max_ulp = apart.max_ulp;
  row.tolerance = allowed ? allowed->max_abs : 0;
  const bool near =
      allowed ? apart.max_abs <= allowed->max_abs && apart.rms <= allowed->rms : apart.max_ulp == 0;
  const bool biased = allowed && apart.bias > allowed->bias;
  row.ok = apart.finite && near && !biased;
  if (!apart.finite)
    row.verdict = "not finite";
  else if (!near)
    row.verdict = "over tolerance";
  else if (biased)
    row.verdict = "biased";
  else
    row.verdict = apart.max_ulp == 0 ? "exact" : "within tolerance";
}

template <class T, class From>
HostBuffers<T> converted(const HostBuffers<From>& host) {
  HostBuffers<T> to;
  to.words = host.words;
  for (std::size_t b = 0; b < kBufferCount; ++b) to.vec4[b].assign(host.vec4[b].begin(), host.vec4[b].end());
  return to;
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
  struct Walk {  ///< through a frame
    const ProbeState& probe;
    std::vector<KickDrift> rows;
    HostBuffers<T> host;
  };
  void check_frame(PassRunner& runner, const ProbeState& probe);
  void check_step(PassRunner& runner, std::size_t step, std::uint32_t substep, Walk& walk);
  void check_lockstep();
  void compare_states(const std::string& name);

  gpu::Device& device_;
  const Model& model_;
  const Solver& solver_;
  ValidationOptions options_;
  Plan plan_;
  ValidationReport report_;
  std::size_t held_ = 0;                                             ///< pinned particles
  std::unique_ptr<Simulation> device_run_, mirror_run_, other_run_;  ///< in lockstep; other: float or double
};

template <class T>
void Validator<T>::check_passes(const Perturbation& perturbation) {
  PassRunner runner(device_, model_, plan_, perturbation);
  for (const ProbeState& probe : probe_states(model_, solver_)) check_frame(runner, probe);
}

/// Whether the solver keeps more than positions and velocities from one substep to the next, so that the
/// frame's first substep differs from the others.
bool keeps_more(const Plan& plan) {
  return std::ranges::any_of(
      plan.buffers, [](const PlanBuffer& b) { return b.id > BufferId::normal && !holds_floats(b.id); });
}

/// Walks through a frame whose state begins as the probe: its start, one substep or two, its end. The mirrors
/// lead, so that each step is checked on what the ones before it leave.
template <class T>
void Validator<T>::check_frame(PassRunner& runner, const ProbeState& probe) {
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
  const auto check_block = [&](Block block, std::uint32_t substep) {
    for (std::size_t step = 0; step < plan_.steps.size(); ++step)
      if (plan_.steps[step].block == block) check_step(runner, step, substep, walk);
  };
  check_block(Block::frame_start, 0);
  for (std::uint32_t k = 0; k < checked; ++k) check_block(Block::substep, k);
  check_block(Block::frame_end, n);
}

template <class T>
bool is_poison(T value) {
  const T expected = poison<T>();  // by its bits: NaN is not equal to itself
  return std::memcmp(&value, &expected, sizeof value) == 0;
}

template <class T>
void poison_mirror(BufferId id, HostBuffers<T>& host) {
  std::ranges::fill(host.words_of(id), kPoison);
  std::ranges::fill(host[id], glm::vec<4, T>(poison<T>()));
}

/// Where neither side wrote, the buffer holds what it held before, on both.
template <class T>
void restore_unwritten(BufferId id, const HostBuffers<T>& before, HostBuffers<T>& got,
                       HostBuffers<T>& expected) {
  const auto& words = before.words_of(id);
  for (std::size_t k = 0; k < words.size(); ++k)
    if (got.words_of(id)[k] == kPoison && expected.words_of(id)[k] == kPoison)
      got.words_of(id)[k] = expected.words_of(id)[k] = words[k];
  const auto& vectors = before[id];
  for (std::size_t p = 0; p < vectors.size(); ++p)
    for (int c = 0; c < 4; ++c)
      if (is_poison(got[id][p][c]) && is_poison(expected[id][p][c]))
        got[id][p][c] = expected[id][p][c] = vectors[p][c];
}

/// Integers must be equal on every device.
void judge_words(ValidationRow& row, const std::vector<std::uint32_t>& got,
                 const std::vector<std::uint32_t>& expected) {
  for (std::size_t k = 0; k < std::min(got.size(), expected.size()); ++k)
    row.max_abs =
        std::max(row.max_abs, std::abs(static_cast<double>(got[k]) - static_cast<double>(expected[k])));
  row.ok = got == expected;
  row.verdict = row.ok ? "exact" : "over tolerance";
}

/// Runs one step on the device and by its mirror, both from the walk's buffers; what the mirror leaves there
/// is what the next step finds.
template <class T>
void Validator<T>::check_step(PassRunner& runner, std::size_t step, std::uint32_t substep, Walk& walk) {
  const PlanStep& planned = plan_.steps[step];
  const ProbeState& probe = walk.probe;
  HostBuffers<T>& host = walk.host;
  const std::uint32_t row_index = plan_.table_row(planned, substep);
  const HostBuffers<T> before = host;
  PassResult<T> result = runner.run(step, host, walk.rows, row_index);
  const MirrorContext context{model_, planned.constants, walk.rows[row_index], row_index, planned.item};
  std::optional<FloatLoss> loss;
  if (!report_.exact_required) loss.emplace(planned, context, host);
  for (const BufferId id : result.outputs)
    if (!runner.use_of(step, id).reads) poison_mirror(id, host);
  run_mirror(planned, context, host);
  if (planned.pass->settle_order) {
    planned.pass->settle_order(result.buffers);
    planned.pass->settle_order(host);
  }

  const std::string check = std::string(planned.pass->name).append(block_suffix(planned.block));
  for (const BufferId id : result.outputs) {
    ValidationRow row{.check = check, .state = probe.name, .buffer = std::string(row_of(id).name)};
    restore_unwritten(id, before, result.buffers, host);
    if (holds_words(id)) {
      judge_words(row, result.buffers.words_of(id), host.words_of(id));
      report_.rows.push_back(std::move(row));
      continue;
    }
    std::optional<Allowance> allowed;
    if (loss) allowed = allowance<T>(loss->in(id), host[id].size(), held_);
    judge(row, difference(result.buffers[id], host[id]), allowed);
    report_.rows.push_back(std::move(row));
  }
  ValidationRow others{.check = check, .state = probe.name, .buffer = "all others"};
  others.ok = result.touched.empty();
  others.verdict = others.ok ? "untouched" : fmt::format("touched: {}", row_of(result.touched[0]).name);
  report_.rows.push_back(std::move(others));
  if (!planned.pass->swaps_state) return;
  std::swap(host[BufferId::position], host[BufferId::position_next]);
  std::swap(host[BufferId::velocity], host[BufferId::velocity_next]);
}

template <class T>
std::vector<glm::vec<4, T>> as_vec4(const std::vector<glm::dvec3>& vectors) {
  std::vector<glm::vec<4, T>> out;
  out.reserve(vectors.size());
  for (const glm::dvec3& v : vectors) out.emplace_back(glm::vec<3, T>(v), T(0));
  return out;
}

template <class T>
void Validator<T>::compare_states(const std::string& name) {
  const State got = device_run_->read(), expected = mirror_run_->read();
  const State other = other_run_ ? other_run_->read() : State{};
  const State& in_float = plan_.in_double() ? other : expected;
  const State& in_double = plan_.in_double() ? expected : other;
  const auto compare = [&](BufferId id, const auto member) {
    ValidationRow row{.check = "lockstep", .state = name, .buffer = std::string(row_of(id).name)};
    const auto reference = as_vec4<T>(expected.*member);
    std::optional<Allowance> allowed;
    if (other_run_) {
      const Difference lost =
          difference(as_vec4<float>(in_float.*member), as_vec4<double>(in_double.*member));
      allowed = allowance<T>(lost, reference.size(), held_);
      allowed->bias = allowed->max_abs;  // errors of many steps are no longer independent
    }
    judge(row, difference(as_vec4<T>(got.*member), reference), allowed);
    report_.rows.push_back(std::move(row));
  };
  compare(BufferId::position, &State::position);
  compare(BufferId::velocity, &State::velocity);
}

template <class T>
void Validator<T>::check_lockstep() {
  device_run_ = GpuSimulation::create(device_, model_, solver_, {.perturb = options_.perturb});
  mirror_run_ = make_cpu_simulation(model_, solver_, plan_.precision);
  if (!report_.exact_required)
    other_run_ = make_cpu_simulation(model_, solver_, plan_.in_double() ? "f32" : "f64");
  const std::uint32_t n = plan_.substeps;
  const double frame_s = model_.scene.solver.frame_s;
  const auto advance = [&](std::uint32_t substeps) {
    for (Simulation* simulation : {device_run_.get(), mirror_run_.get(), other_run_.get()})
      if (simulation != nullptr) simulation->advance(frame_s * substeps / n, substeps);
  };
  for (std::uint32_t left = options_.lockstep_substeps; left > 0;) {
    const std::uint32_t substeps = std::min(left, n);
    advance(substeps);
    left -= substeps;
  }
  if (options_.lockstep_substeps > 0) compare_states(fmt::format("{} substeps", options_.lockstep_substeps));
  for (std::uint32_t frame = 0; frame < options_.lockstep_frames; ++frame) advance(n);
  if (options_.lockstep_frames > 0) compare_states(fmt::format("{} frames on", options_.lockstep_frames));
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
