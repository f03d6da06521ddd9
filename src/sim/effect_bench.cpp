// Both sides start every turn from the same state, so that they compute the same frame; the cost is taken
// turn by turn, so that what else the machine does falls on both.
#include "sim/effect_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "model/model.h"
#include "scene/effects.h"
#include "sim/gpu_simulation.h"
#include "solvers/solver.h"

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::uint32_t automatic_substeps(Scene scene) {
  scene.solver.substeps = 0;
  return substeps_per_frame(build_model(scene), find_solver(scene.solver.name));
}

/// The kernel that was asked for, where it fits the plan.
std::string fitting_kernel(gpu::Device& device, const Scene& scene, const std::string& kernel) {
  if (kernel.empty() || kernel == "auto") return kernel;
  const Plan plan = compile_plan(build_model(scene), find_solver(scene.solver.name), scene.solver.precision);
  const auto fitting = fitting_kernel_names(device, plan);
  return std::ranges::find(fitting, kernel) == fitting.end() ? "auto" : kernel;
}

std::unique_ptr<GpuSimulation> simulation_of(gpu::Device& device, const Scene& scene,
                                             const std::string& kernel,
                                             std::shared_ptr<GpuPipelines> pipelines) {
  return GpuSimulation::create(
      device, build_model(scene), find_solver(scene.solver.name),
      {.perturb = {}, .pipelines = std::move(pipelines), .kernel = fitting_kernel(device, scene, kernel)});
}

/// How many of a frame's substeps stay below so many particle·substeps; two at least, so that the first can
/// be told from the others.
std::uint32_t substeps_within(const Plan& plan, double most, std::uint32_t substeps) {
  const double fit = most / static_cast<double>(plan.steps.at(0).range.items());
  return static_cast<std::uint32_t>(std::clamp(fit, std::min(2.0, double(substeps)), double(substeps)));
}

/// A scene on the device, and what its turns took.
class Side {
 public:
  Side(gpu::Device& device, Scene scene, std::uint32_t substeps, const EffectBenchOptions& options,
       std::shared_ptr<GpuPipelines> pipelines)
      : frame_s_(scene.solver.frame_s), substeps_(substeps), automatic_(automatic_substeps(scene)) {
    scene.solver.substeps = substeps;
    simulation_ = simulation_of(device, scene, options.kernel, std::move(pipelines));
    timed_ = substeps_within(simulation_->plan(), options.turn_most, substeps);
  }
  /// One frame from `state`, or its first substeps. Returns a whole frame's milliseconds: what the first
  /// substep alone does, as making lists, is counted once.
  double turn(const State& state) {
    const Spent all = spent_on(state, timed_);
    if (timed_ == substeps_) return all.once_ms + all.substeps_ms;
    const Spent first = spent_on(state, 1);
    const double each_ms = (all.substeps_ms - first.substeps_ms) / (timed_ - 1);
    return all.once_ms + first.substeps_ms + each_ms * (substeps_ - 1);
  }
  GpuSimulation& simulation() { return *simulation_; }
  EffectSide result(const std::vector<double>& frames_ms) const {
    return {.frame_ms = sample_of(frames_ms),
            .kernel = describe(simulation_->kernel()),
            .bytes = simulation_->bytes_allocated(),
            .dispatches = simulation_->dispatches_expected(substeps_),
            .automatic = automatic_};
  }

 private:
  struct Spent {
    double once_ms = 0.0;      ///< on steps of the frame
    double substeps_ms = 0.0;  ///< on those of all substeps
  };
  Spent spent_on(const State& state, std::uint32_t substeps) {
    simulation_->write(state);
    simulation_->advance(frame_s_ * substeps / substeps_, substeps);
    simulation_->wait();
    const std::vector<double> steps = simulation_->step_ms();
    Spent spent;
    for (std::size_t step = 0; step < steps.size(); ++step)
      (simulation_->plan().steps[step].block == Block::substep ? spent.substeps_ms : spent.once_ms) +=
          steps[step];
    return spent;
  }

  double frame_s_;
  std::uint32_t substeps_, automatic_, timed_ = 0;
  std::unique_ptr<GpuSimulation> simulation_;
};

/// The state after some time of the scene as it stands, and that time.
State state_after(gpu::Device& device, const Scene& scene, const EffectBenchOptions& options, double& time_s,
                  const std::shared_ptr<GpuPipelines>& pipelines) {
  const auto simulation = simulation_of(device, scene, options.kernel, pipelines);
  const std::uint32_t n = simulation->plan().substeps;
  const double substep_s = scene.solver.frame_s / n;
  const std::uint32_t all = static_cast<std::uint32_t>(std::lround(options.time_s / substep_s));
  std::uint32_t left = substeps_within(simulation->plan(), options.warm_most, std::max(all, 1u));
  if (all == 0) left = 0;
  for (std::uint32_t now = 0; left > 0; left -= now) {
    now = std::min(left, n);
    simulation->advance(substep_s * now, now);
  }
  State state = simulation->read();
  time_s = std::exchange(state.time_s, 0.0);
  return state;
}

/// The constants of `integrate` that are 0 without the effect and were not with it.
std::vector<std::string> constants_lost(const Plan& with, const Plan& without) {
  std::vector<std::string> lost;
  for (std::size_t k = 0; k < with.steps[0].constants.size(); ++k) {
    const Constant &on = with.steps[0].constants[k], &off = without.steps[0].constants[k];
    if (on.value != 0 && off.value == 0) lost.emplace_back(on.name);
  }
  return lost;
}

std::string names_of(std::span<const Effect> list) {
  std::string names;
  for (const Effect& effect : list) names += (names.empty() ? "" : ", ") + std::string(effect.name);
  return names;
}

EffectRow compare(gpu::Device& device, const Scene& with_scene, const Scene& without_scene,
                  const State& state, const EffectBenchOptions& options,
                  const std::shared_ptr<GpuPipelines>& pipelines) {
  const std::uint32_t substeps =
      with_scene.solver.substeps != 0 ? with_scene.solver.substeps : automatic_substeps(with_scene);
  Side with(device, with_scene, substeps, options, pipelines);
  Side without(device, without_scene, substeps, options, pipelines);
  const std::vector<std::string> lost = constants_lost(with.simulation().plan(), without.simulation().plan());
  std::optional<Side> lacking;  // what runs without the effect, in a build that never had it
  const bool plain = !without.simulation().plan().reaching.asked();  // else other modules run
  if (plain && lost.size() == 1 && GpuPipelines::can_lack(lost[0]))
    lacking.emplace(device, without_scene, substeps, options,
                    std::make_shared<GpuPipelines>(device, lost[0]));
  with.turn(state), without.turn(state);
  if (lacking) lacking->turn(state);
  std::vector<double> with_ms, without_ms, cost, absent;
  for (std::uint32_t turn = 0; turn < options.repetitions; ++turn) {
    with_ms.push_back(with.turn(state));
    without_ms.push_back(without.turn(state));
    cost.push_back((with_ms.back() - without_ms.back()) / without_ms.back());
    if (lacking) absent.push_back(without_ms.back() / lacking->turn(state) - 1.0);
  }
  const auto began = Clock::now();
  Side(device, with_scene, substeps, options, pipelines).simulation().write(state);
  EffectRow row{.toggle_ms = ms_since(began)};
  row.with = with.result(with_ms);
  row.without = without.result(without_ms);
  const Sample share = sample_of(cost);
  row.cost = share.median;
  row.cost_spread = share.spread;
  if (lacking) row.absent_cost = sample_of(absent).median, row.absent_spread = sample_of(absent).spread;
  return row;
}

}  // namespace

EffectBenchReport bench_effects(gpu::Device& device, const Scene& scene, const EffectBenchOptions& options,
                                const std::function<void(const std::string&)>& note) {
  if (!device.info().timestamps)
    throw error(Exit::no_device, "{} has no timestamps; bench needs them", device.info().name);
  const auto pipelines = std::make_shared<GpuPipelines>(device);
  for (const std::string& name : options.only)
    if (std::ranges::find(effects(), name, &Effect::name) == effects().end())
      throw error(Exit::usage, "\"{}\" is no effect; it must be one of {}", name, names_of(effects()));
  double warmed_s = 0.0;
  const State state = state_after(device, scene, options, warmed_s, pipelines);
  const Model model = build_model(scene);
  EffectBenchReport report{.device = device.info().name,
                           .scene = scene.title.empty() ? scene.source : scene.title,
                           .solver = scene.solver.name,
                           .precision = scene.solver.precision,
                           .nx = model.grid.nx,
                           .ny = model.grid.ny,
                           .time_s = warmed_s};
  for (const Effect& effect : effects()) {
    if (!options.only.empty() && std::ranges::find(options.only, effect.name) == options.only.end()) continue;
    note(std::string(effect.name));
    const bool there = has_effect(scene, effect);
    const Scene with = there ? scene : with_effect(scene, effect.name);
    Scene without = without_effect(with, effect.name);
    EffectRow row;
    const std::string lacks = what_solver_lacks(build_model(with), find_solver(with.solver.name));
    if (lacks.empty())
      row = compare(device, with, without, state, options, pipelines);
    else
      row.left_out = with.solver.name + " " + lacks;
    row.effect = effect.name;
    row.in_scene = there;
    report.rows.push_back(std::move(row));
  }
  return report;
}

}  // namespace weft
