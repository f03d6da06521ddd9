// The device against the CPU reference: every pass by itself, then frames in lockstep.
#include "sim/validate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
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
/// Where float is exact by luck, an ulp of the largest number remains.
Allowance allowance(const Difference& lost, std::size_t count, std::size_t held) {
  constexpr double kMax = 16, kRms = 8, kUlp = std::numeric_limits<float>::epsilon();
  const double n = static_cast<double>(count), ulp = kUlp * lost.magnitude;
  const double at_pins = kMax * lost.max_abs * static_cast<double>(held) / n;
  return {.max_abs = kMax * lost.max_abs + ulp,
          .rms = kRms * lost.rms + ulp,
          .bias = (kRms * lost.rms + ulp) / std::sqrt(n) + at_pins + lost.bias};
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

HostBuffers<double> in_double(const HostBuffers<float>& host) {
  HostBuffers<double> wide;
  wide.words = host.words;
  for (std::size_t b = 0; b < kBufferCount; ++b)
    wide.vec4[b].assign(host.vec4[b].begin(), host.vec4[b].end());
  return wide;
}

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
    HostBuffers<float> host;
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
  std::unique_ptr<Simulation> device_run_, float_run_, double_run_;  ///< in lockstep
};

void Validator::check_passes(const Perturbation& perturbation) {
  PassRunner runner(device_, model_, plan_, perturbation);
  for (const ProbeState& probe : probe_states(model_, solver_)) check_frame(runner, probe);
}

/// Whether the solver keeps more than positions and velocities from one substep to the next, so that the
/// frame's first substep differs from the others.
bool keeps_more(const Plan& plan) {
  return std::ranges::any_of(plan.buffers, [](const PlanBuffer& b) { return b.id > BufferId::normal; });
}

/// Walks through a frame whose state begins as the probe: its start, one substep or two, its end. The mirrors
/// lead, so that each step is checked on what the ones before it leave.
void Validator::check_frame(PassRunner& runner, const ProbeState& probe) {
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

bool is_poison(float value) { return std::bit_cast<std::uint32_t>(value) == kPoison; }

void poison(HostBuffers<float>& host, BufferId id) {
  std::ranges::fill(host.words_of(id), kPoison);
  std::ranges::fill(host[id], glm::vec4(std::bit_cast<float>(kPoison)));
}

/// Where neither side wrote, the buffer holds what it held before, on both.
void restore_unwritten(BufferId id, const HostBuffers<float>& before, HostBuffers<float>& got,
                       HostBuffers<float>& expected) {
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
void Validator::check_step(PassRunner& runner, std::size_t step, std::uint32_t substep, Walk& walk) {
  const PlanStep& planned = plan_.steps[step];
  const ProbeState& probe = walk.probe;
  HostBuffers<float>& host = walk.host;
  const std::uint32_t row_index = plan_.table_row(planned, substep);
  const HostBuffers<float> before = host;
  PassResult result = runner.run(step, host, walk.rows, row_index);
  const MirrorContext context{model_, planned.constants, walk.rows[row_index], row_index, planned.item};
  HostBuffers<double> wide;
  if (!report_.exact_required) {
    wide = in_double(host);
    planned.pass->mirror_f64(context, wide);
  }
  for (const BufferId id : result.outputs)
    if (!runner.use_of(step, id).reads) poison(host, id);
  planned.pass->mirror_f32(context, host);
  if (planned.pass->settle_order) {
    planned.pass->settle_order(model_, result.buffers);
    planned.pass->settle_order(model_, host);
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
    if (!report_.exact_required) allowed = allowance(difference(host[id], wide[id]), host[id].size(), held_);
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

void Validator::compare_states(const std::string& name) {
  const State got = device_run_->read(), expected = float_run_->read();
  const State exact = double_run_ ? double_run_->read() : State{};
  const auto compare = [&](BufferId id, const auto member) {
    ValidationRow row{.check = "lockstep", .state = name, .buffer = std::string(row_of(id).name)};
    const auto reference = as_vec4<float>(expected.*member);
    std::optional<Allowance> allowed;
    if (double_run_) {
      allowed = allowance(difference(reference, as_vec4<double>(exact.*member)), reference.size(), held_);
      allowed->bias = allowed->max_abs;  // errors of many steps are no longer independent
    }
    judge(row, difference(as_vec4<float>(got.*member), reference), allowed);
    report_.rows.push_back(std::move(row));
  };
  compare(BufferId::position, &State::position);
  compare(BufferId::velocity, &State::velocity);
}

void Validator::check_lockstep() {
  device_run_ = GpuSimulation::create(device_, model_, solver_, {.perturb = options_.perturb});
  float_run_ = make_cpu_simulation(model_, solver_, plan_.precision);
  if (!report_.exact_required) double_run_ = make_cpu_simulation(model_, solver_, "f64");
  const std::uint32_t n = plan_.substeps;
  const double frame_s = model_.scene.solver.frame_s;
  const auto advance = [&](std::uint32_t substeps) {
    for (Simulation* simulation : {device_run_.get(), float_run_.get(), double_run_.get()})
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
  return Validator(device, model, solver, options).run();
}

}  // namespace weft
