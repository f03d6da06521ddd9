// Both sides start every turn from the same state, so that they compute the same frame; the cost is taken
// turn by turn, so that what else the machine does falls on both.
#include "sim/effect_bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "core/error.h"
#include "model/model.h"
#include "plan/plan.h"
#include "scene/effects.h"
#include "sim/gpu_pipelines.h"
#include "sim/native_simulation.h"
#include "sim/timed_scene.h"
#include "solvers/solver.h"

namespace weft {
namespace {

using Clock = std::chrono::steady_clock;

/// Substeps of a frame's beginning: enough for a device to compute it as it computes whole frames
/// (GpuSpreadFrames).
constexpr std::uint32_t kBeginning = 8;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::uint32_t automatic_substeps(Scene scene) {
  scene.solver.substeps = 0;
  return substeps_per_frame(build_model(scene), find_solver(scene.solver.name));
}

/// How many of a frame's substeps stay below so many particle·substeps; two at least, so that the first can
/// be told from the others.
std::uint32_t substeps_within(const Plan& plan, double most, std::uint32_t substeps) {
  const double fit = most / static_cast<double>(plan.steps.at(0).range.items());
  return static_cast<std::uint32_t>(std::clamp(fit, std::min(2.0, double(substeps)), double(substeps)));
}

/// Makes the sides of comparisons, all on one device.
struct Bench {
  std::function<std::unique_ptr<TimedScene>(const Scene&)> make;
  /// In a program whose kernels lack what that constant stands for; null where there is none.
  std::function<std::unique_ptr<TimedScene>(const Scene&, const std::string& constant)> make_lacking;
  /// Why a scene does not run; empty when it does.
  std::function<std::string(const Scene&)> lacks;
};

/// Of a whole frame.
struct FrameTime {
  double ms, processor_ms;
};

/// A scene, and what its turns took.
class Side {
 public:
  Side(std::unique_ptr<TimedScene> timed, const Scene& scene, double turn_most)
      : timed_(std::move(timed)),
        frame_s_(scene.solver.frame_s),
        substeps_(scene.solver.substeps),
        automatic_(automatic_substeps(scene)),
        turn_substeps_(substeps_within(timed_->plan(), turn_most, substeps_)) {}
  /// One frame from `state`, or its first substeps: what its beginning alone does, as making lists, is
  /// counted once.
  void turn(const State& state) {
    const RunTime all = run(state, turn_substeps_);
    if (turn_substeps_ == substeps_) return keep({all.once_ms + all.substeps_ms, all.processor_ms});
    const std::uint32_t few = turn_substeps_ > 2 * kBeginning ? kBeginning : 1;
    const RunTime first = run(state, few);
    const double others = static_cast<double>(substeps_ - few) / (turn_substeps_ - few);
    keep({all.once_ms + first.substeps_ms + others * (all.substeps_ms - first.substeps_ms),
          first.processor_ms + others * (all.processor_ms - first.processor_ms)});
  }
  void forget() { frame_ms_.clear(), processor_ms_.clear(); }
  TimedScene& timed() { return *timed_; }
  double latest_ms() const { return frame_ms_.back(); }
  double latest_processor_ms() const { return processor_ms_.back(); }
  EffectSide result() const {
    return {.frame_ms = sample_of(frame_ms_),
            .processor_ms = sample_of(processor_ms_),
            .kernel = timed_->runner(),
            .bytes = timed_->bytes(),
            .dispatches = timed_->dispatches(substeps_),
            .automatic = automatic_};
  }

 private:
  RunTime run(const State& state, std::uint32_t substeps) {
    return timed_->run(state, frame_s_ * substeps / substeps_, substeps);
  }
  void keep(const FrameTime& time) {
    frame_ms_.push_back(time.ms);
    processor_ms_.push_back(time.processor_ms);
  }

  std::unique_ptr<TimedScene> timed_;
  double frame_s_;
  std::uint32_t substeps_, automatic_, turn_substeps_;
  std::vector<double> frame_ms_, processor_ms_;
};

/// The state after some time of the scene as it stands, and that time.
State state_after(TimedScene& timed, const Scene& scene, const EffectBenchOptions& options, double& time_s) {
  const std::uint32_t n = timed.plan().substeps;
  const double substep_s = scene.solver.frame_s / n;
  const std::uint32_t all = static_cast<std::uint32_t>(std::lround(options.time_s / substep_s));
  std::uint32_t left = substeps_within(timed.plan(), options.warm_most, std::max(all, 1u));
  if (all == 0) left = 0;
  for (std::uint32_t now = 0; left > 0; left -= now) {
    now = std::min(left, n);
    timed.advance(substep_s * now, now);
  }
  State state = timed.read();
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

EffectRow compare(const Bench& bench, Scene with_scene, Scene without_scene, const State& state,
                  const EffectBenchOptions& options) {
  if (with_scene.solver.substeps == 0) with_scene.solver.substeps = automatic_substeps(with_scene);
  without_scene.solver.substeps = with_scene.solver.substeps;
  Side with(bench.make(with_scene), with_scene, options.turn_most);
  Side without(bench.make(without_scene), without_scene, options.turn_most);
  const std::vector<std::string> lost = constants_lost(with.timed().plan(), without.timed().plan());
  std::optional<Side> lacking;  // what runs without the effect, in a build that never had it
  const bool plain = !without.timed().plan().reaching.asked();  // else other modules run
  if (plain && lost.size() == 1)
    if (auto timed = bench.make_lacking(without_scene, lost[0]))
      lacking.emplace(std::move(timed), without_scene, options.turn_most);
  std::vector<double> cost, processor_cost, absent;
  for (std::uint32_t turn = 0; turn <= options.repetitions; ++turn) {
    if (turn == 1) with.forget(), without.forget();  // the first warms up
    with.turn(state), without.turn(state);
    if (lacking) lacking->turn(state);
    if (turn == 0) continue;
    cost.push_back(with.latest_ms() / without.latest_ms() - 1.0);
    processor_cost.push_back(with.latest_processor_ms() / without.latest_processor_ms() - 1.0);
    if (lacking) absent.push_back(without.latest_ms() / lacking->latest_ms() - 1.0);
  }
  const auto began = Clock::now();
  bench.make(with_scene)->write(state);
  EffectRow row{.toggle_ms = ms_since(began)};
  row.with = with.result();
  row.without = without.result();
  const Sample share = sample_of(cost);
  row.cost = share.median;
  row.cost_spread = share.spread;
  row.processor_cost = sample_of(processor_cost).median;
  if (lacking) row.absent_cost = sample_of(absent).median, row.absent_spread = sample_of(absent).spread;
  return row;
}

void refuse_unknown(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::ranges::find(effects(), name, &Effect::name) == effects().end())
      throw error(Exit::usage, "\"{}\" is no effect; it must be one of {}", name, names_of(effects()));
}

EffectBenchReport report_on(const Scene& scene, const std::string& device) {
  const Model model = build_model(scene);
  return {.device = device,
          .scene = scene.title.empty() ? scene.source : scene.title,
          .solver = scene.solver.name,
          .precision = scene.solver.precision,
          .nx = model.grid.nx,
          .ny = model.grid.ny};
}

void compare_all(const Bench& bench, const Scene& scene, const State& state,
                 const EffectBenchOptions& options, const std::function<void(const std::string&)>& note,
                 EffectBenchReport& report) {
  for (const Effect& effect : effects()) {
    if (!options.only.empty() && std::ranges::find(options.only, effect.name) == options.only.end()) continue;
    note(std::string(effect.name));
    const bool there = has_effect(scene, effect);
    const Scene with = there ? scene : with_effect(scene, effect.name);
    EffectRow row;
    const std::string lacks = bench.lacks(with);
    if (lacks.empty())
      row = compare(bench, with, without_effect(with, effect.name), state, options);
    else
      row.left_out = lacks;
    row.effect = effect.name;
    row.in_scene = there;
    report.rows.push_back(std::move(row));
  }
}

/// Why the scene's solver does not run it, or why nobody does, as effects may exclude each other; empty when
/// it does.
std::string solver_lacks(const Scene& scene) {
  const Model model = build_model(scene);
  const Solver& solver = find_solver(scene.solver.name);
  const std::string lacks = what_solver_lacks(model, solver);
  if (!lacks.empty()) return scene.solver.name + " " + lacks;
  try {
    compile_plan(model, solver, scene.solver.precision);
  } catch (const Error& refusal) {
    if (refusal.code() != Exit::usage) throw;
    return refusal.what();
  }
  return {};
}

}  // namespace

EffectBenchReport bench_effects(gpu::Device& device, const Scene& scene, const EffectBenchOptions& options,
                                const std::function<void(const std::string&)>& note) {
  if (!device.info().timestamps)
    throw error(Exit::no_device, "{} has no timestamps; bench needs them", device.info().name);
  refuse_unknown(options.only);
  const auto pipelines = std::make_shared<GpuPipelines>(device);
  const Bench bench{
      .make = [&](const Scene& made) { return time_on_gpu(device, made, options.kernel, pipelines); },
      .make_lacking = [&](const Scene& made, const std::string& constant) -> std::unique_ptr<TimedScene> {
        if (!GpuPipelines::can_lack(constant)) return nullptr;
        return time_on_gpu(device, made, options.kernel, std::make_shared<GpuPipelines>(device, constant));
      },
      .lacks = solver_lacks};
  EffectBenchReport report = report_on(scene, device.info().name);
  const State state = state_after(*bench.make(scene), scene, options, report.time_s);
  compare_all(bench, scene, state, options, note, report);
  return report;
}

EffectBenchReport bench_effects_on_native(const Scene& scene, const EffectBenchOptions& options,
                                          const std::function<void(const std::string&)>& note) {
  refuse_unknown(options.only);
  const auto lacks = [](const Scene& made) {
    const std::string by_solver = solver_lacks(made);
    if (!by_solver.empty()) return by_solver;
    return native_lacks(build_model(made), find_solver(made.solver.name), made.solver.precision);
  };
  if (const std::string missing = lacks(scene); !missing.empty())
    throw error(Exit::usage,
                "{}: {}; bench --effects needs a scene that its device runs, or --device with a Vulkan one",
                scene.source, missing);
  const auto first = time_on_native(scene, 0);
  EffectBenchReport report = report_on(scene, "");
  const State state = state_after(*first, scene, options, report.time_s);
  const Bench bench{
      .make = [threads = first->threads()](const Scene& made) { return time_on_native(made, threads); },
      .make_lacking = [](const Scene&, const std::string&) { return std::unique_ptr<TimedScene>(); },
      .lacks = lacks};
  report.device = bench.make(scene)->runner();
  compare_all(bench, scene, state, options, note, report);
  return report;
}

}  // namespace weft
