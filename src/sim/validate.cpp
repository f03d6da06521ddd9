// The device against the CPU reference: every pass by itself, then frames in lockstep.
#include "sim/validate.h"

#include <algorithm>
#include <cstdlib>

#include "core/error.h"
#include "passes/tables.h"
#include "sim/compare.h"
#include "sim/gpu_simulation.h"
#include "sim/pass_runner.h"
#include "sim/probe_states.h"

namespace weft {
namespace {

std::string_view block_suffix(Block block) { return block == Block::frame_end ? " (frame end)" : ""; }

/// Fills in the verdict of a comparison from its difference.
void judge(ValidationRow& row, const Difference& apart, bool exact, const Tolerance& tolerance,
           double steps) {
  row.max_abs = apart.max_abs;
  row.rms = apart.rms;
  row.max_ulp = apart.max_ulp;
  row.tolerance = exact ? 0 : steps * (tolerance.absolute + tolerance.relative * apart.magnitude);
  row.ok = apart.finite && (exact ? apart.max_ulp == 0 : apart.max_abs <= row.tolerance);
  if (!apart.finite)
    row.verdict = "not finite";
  else if (!row.ok)
    row.verdict = "over tolerance";
  else
    row.verdict = apart.max_ulp == 0 ? "exact" : "within tolerance";
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
    report_.exact_required = device.info().software;
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
  void compare_states(const std::string& name, const State& got, const State& expected, double steps);

  gpu::Device& device_;
  const Model& model_;
  const Solver& solver_;
  ValidationOptions options_;
  Plan plan_;
  ValidationReport report_;
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
  for (const PlanBuffer& buffer : plan_.buffers)
    if (buffer.id == BufferId::compensation) walk.host[buffer.id].resize(model_.grid.count());
  load_state(model_, probe.state, walk.host);
  const auto check_block = [&](Block block, std::uint32_t substep) {
    for (std::size_t step = 0; step < plan_.steps.size(); ++step)
      if (plan_.steps[step].block == block) check_step(runner, step, substep, walk);
  };
  check_block(Block::frame_start, 0);
  for (std::uint32_t k = 0; k < checked; ++k) check_block(Block::substep, k);
  check_block(Block::frame_end, n);
}

void Validator::check_step(PassRunner& runner, std::size_t step, std::uint32_t substep, Walk& walk) {
  const PlanStep& planned = plan_.steps[step];
  const ProbeState& probe = walk.probe;
  HostBuffers<float>& host = walk.host;
  const std::uint32_t row_index = plan_.table_row(planned, substep);
  const PassResult result = runner.run(step, host, walk.rows, row_index);
  planned.pass->mirror_f32({model_, planned.constants, walk.rows[row_index], row_index, planned.item}, host);

  const std::string check = std::string(planned.pass->name).append(block_suffix(planned.block));
  for (const BufferId id : result.outputs) {
    ValidationRow row{.check = check, .state = probe.name, .buffer = std::string(row_of(id).name)};
    judge(row, difference(result.buffers[id], host[id]), report_.exact_required, planned.pass->tolerance, 1);
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

std::vector<glm::vec4> as_vec4(const std::vector<glm::dvec3>& vectors) {
  std::vector<glm::vec4> out;
  out.reserve(vectors.size());
  for (const glm::dvec3& v : vectors) out.emplace_back(glm::vec3(v), 0.0f);
  return out;
}

void Validator::compare_states(const std::string& name, const State& got, const State& expected,
                               double steps) {
  const auto compare = [&](BufferId id, const auto& a, const auto& b) {
    ValidationRow row{.check = "lockstep", .state = name, .buffer = std::string(row_of(id).name)};
    // Errors of one dispatch add up at worst: an explicit step below its bound does not amplify them.
    judge(row, difference(as_vec4(a), as_vec4(b)), report_.exact_required, plan_.steps[0].pass->tolerance,
          steps);
    report_.rows.push_back(std::move(row));
  };
  compare(BufferId::position, got.position, expected.position);
  compare(BufferId::velocity, got.velocity, expected.velocity);
}

void Validator::check_lockstep() {
  const auto device = GpuSimulation::create(device_, model_, solver_, {.perturb = options_.perturb});
  const auto reference = make_cpu_simulation(model_, solver_, plan_.precision);
  const std::uint32_t n = plan_.substeps;
  const double frame_s = model_.scene.solver.frame_s;
  for (std::uint32_t left = options_.lockstep_substeps; left > 0;) {
    const std::uint32_t substeps = std::min(left, n);
    for (Simulation* simulation : {static_cast<Simulation*>(device.get()), reference.get()})
      simulation->advance(frame_s * substeps / n, substeps);
    left -= substeps;
  }
  if (options_.lockstep_substeps > 0)
    compare_states(fmt::format("{} substeps", options_.lockstep_substeps), device->read(), reference->read(),
                   options_.lockstep_substeps);
  for (std::uint32_t frame = 0; frame < options_.lockstep_frames; ++frame)
    for (Simulation* simulation : {static_cast<Simulation*>(device.get()), reference.get()})
      simulation->advance(frame_s, n);
  if (options_.lockstep_frames > 0)
    compare_states(fmt::format("{} frames on", options_.lockstep_frames), device->read(), reference->read(),
                   options_.lockstep_substeps + double(options_.lockstep_frames) * n);
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
