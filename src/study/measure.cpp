// The first run is compared frame by frame and, after a warm-up, is also the first to be timed: reading the
// state between frames does not enter a device's own timestamps.
#include "study/measure.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "model/measures.h"
#include "native/features.h"
#include "plan/plan.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"

namespace weft::study {
namespace {

using namespace std::string_view_literals;
using Clock = std::chrono::steady_clock;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::array kPrecisions{"f32"sv, "f32k"sv, "f64"sv};

/// A simulation on the bench, and the milliseconds its frames take.
class Run {
 public:
  Run(const Bench& bench, const Model& model, const Setting& setting) : model_(with_setting(model, setting)) {
    const Solver& solver = find_solver(setting.solver);
    if (bench.device == nullptr) {
      simulation_ = bench.on_host(model_, solver, setting.precision);
      return;
    }
    auto on_gpu =
        GpuSimulation::create(*bench.device, model_, solver, {.perturb = {}, .pipelines = bench.pipelines});
    on_gpu_ = on_gpu.get();
    simulation_ = std::move(on_gpu);
    timestamps_ = bench.device->info().timestamps;
  }

  Simulation& simulation() { return *simulation_; }
  const Model& model() const { return model_; }
  bool wall_clock() const { return !timestamps_; }

  /// Advances one frame and waits for it. Returns milliseconds.
  double timed_frame(double frame_s, std::uint32_t substeps, FrameStats& stats) {
    const auto began = Clock::now();
    stats = simulation_->advance(frame_s, substeps);
    if (on_gpu_ != nullptr) on_gpu_->wait();
    const double wall_ms = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
    if (!timestamps_) return wall_ms;
    const std::vector<double> steps = on_gpu_->step_ms();
    return std::accumulate(steps.begin(), steps.end(), 0.0);
  }

  /// Pipelines are compiled and caches filled by one frame that does not count.
  void warm_up() {
    FrameStats stats;
    const State start = simulation_->read();
    timed_frame(model_.scene.solver.frame_s, simulation_->plan().substeps, stats);
    simulation_->write(start);
  }

 private:
  Model model_;
  std::unique_ptr<Simulation> simulation_;
  GpuSimulation* on_gpu_ = nullptr;
  bool timestamps_ = false;
};

/// Calls frame(index, length_s, substeps) for every frame of `time_s`; false ends it.
template <class Frame>
void for_each_frame(const Model& model, std::uint32_t substeps, double time_s, Frame&& frame) {
  const double frame_s = model.scene.solver.frame_s;
  const FramePlan frames = frames_for(time_s, frame_s, substeps);
  for (std::uint64_t f = 0; f < frames.whole; ++f)
    if (!frame(f + 1, frame_s, substeps)) return;
  if (frames.rest_substeps > 0) frame(frames.whole + 1, frames.rest_s, frames.rest_substeps);
}

void ask(const Stop& stop) {
  if (stop && stop()) throw Error(Exit::interrupted, "interrupted");
}

double diagonal_m(const Model& model) { return std::hypot(model.grid.width_m(), model.grid.height_m()); }

double free_mass_kg(const Model& model) {
  double sum = 0.0;
  for (const double w : model.relative_inverse_mass)
    if (w != 0.0) sum += model.interior_mass_kg / w;
  return sum;
}

/// Adds to the point what one output frame says.
void compare_frame(const Model& model, const State& got, const State& expected, Point& point) {
  const double error_m = frame_distance(got, expected);
  point.error_m = std::max(point.error_m, error_m);
  if (!(error_m <= diagonal_m(model))) {
    point.diverged = true;
    point.error_m = kInfinite;
    return;
  }
  const Stretch stretched = stretch(model, got);
  point.max_stretch = std::max(point.max_stretch, stretched.maximum);
  point.p99_stretch = std::max(point.p99_stretch, stretched.p99);
  const double mass_kg = free_mass_kg(model);
  if (mass_kg > 0.0)
    point.momentum_error_m_s =
        std::max(point.momentum_error_m_s,
                 glm::length(linear_momentum(model, got) - linear_momentum(model, expected)) / mass_kg);
}

struct TimedRun {
  double ms = 0, simulated_s = 0;
  std::uint64_t springs = 0;
};

TimedRun compared_run(Run& run, const Reference& reference, double time_s, const Stop& stop, Point& point,
                      State& last) {
  TimedRun timed;
  for_each_frame(run.model(), point.setting.substeps, time_s,
                 [&](std::uint64_t f, double frame_s, std::uint32_t n) {
                   ask(stop);
                   FrameStats stats;
                   timed.ms += run.timed_frame(frame_s, n, stats);
                   timed.springs += stats.spring_evaluations;
                   timed.simulated_s += frame_s;
                   last = run.simulation().read();
                   compare_frame(run.model(), last, reference.frames.at(f), point);
                   return !point.diverged;
                 });
  return timed;
}

double timed_run_ms(Run& run, const State& start, std::uint32_t substeps, double time_s, const Stop& stop) {
  run.simulation().write(start);
  double ms = 0.0;
  for_each_frame(run.model(), substeps, time_s, [&](std::uint64_t, double frame_s, std::uint32_t n) {
    ask(stop);
    FrameStats stats;
    ms += run.timed_frame(frame_s, n, stats);
    return true;
  });
  return ms;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The scene with nothing in it that takes or gives energy, or nothing when contact could.
std::optional<Model> conservative(const Model& model) {
  Scene scene = model.scene;
  if (!scene.spheres.empty() || !scene.capsules.empty() || !scene.boxes.empty() || !scene.meshes.empty())
    return {};
  scene.material.damping_s = 0.0;
  scene.air.reset();
  scene.wind.reset();
  scene.aerodynamics.reset();
  scene.floor.reset();
  return build_model(scene);
}

/// Largest |E(t) − E(0)| over the largest kinetic energy on the way [1]; nothing when the cloth reached the
/// floor that its own scene has.
std::optional<double> energy_drift(const Bench& bench, const Model& model, const Setting& setting,
                                   double time_s, const Stop& stop) {
  const std::optional<Model> quiet = conservative(model);
  if (!quiet) return {};
  Run run(bench, *quiet, setting);
  const double start_j = energy(*quiet, run.simulation().read()).total();
  double drift_j = 0.0, scale_j = 0.0;
  bool touched = false;
  for_each_frame(*quiet, setting.substeps, time_s, [&](std::uint64_t, double frame_s, std::uint32_t n) {
    ask(stop);
    FrameStats stats;
    run.timed_frame(frame_s, n, stats);
    const State state = run.simulation().read();
    const Energy now = energy(*quiet, state);
    touched = touched || deepest_penetration(model, state) > 0.0;
    const double off_j = std::abs(now.total() - start_j);
    drift_j = std::isfinite(off_j) ? std::max(drift_j, off_j) : kInfinite;
    scale_j = std::max(scale_j, now.kinetic_j);
    return !touched && std::isfinite(off_j);
  });
  if (touched || scale_j == 0.0) return {};
  return drift_j / scale_j;
}

double rms_to(const std::vector<glm::dvec3>& positions, const State& state) {
  State rest;
  rest.position = positions;
  return frame_distance(state, rest);
}

void time_further_runs(Run& run, const State& start, double time_s, const MeasureOptions& options,
                       const Stop& stop, double first_ms, double simulated_s, Point& point) {
  std::vector<double> runs_ms{first_ms};
  const auto began = Clock::now();
  while (!point.diverged && runs_ms.size() < options.run_count_max &&
         std::chrono::duration<double>(Clock::now() - began).count() < options.timing_s)
    runs_ms.push_back(timed_run_ms(run, start, point.setting.substeps, time_s, stop));
  const auto [fastest, slowest] = std::minmax_element(runs_ms.begin(), runs_ms.end());
  point.run_count = static_cast<std::uint32_t>(runs_ms.size());
  point.ms_per_s = median(runs_ms) / simulated_s;
  point.ms_spread = 0.5 * (*slowest - *fastest) / simulated_s;
}

}  // namespace

std::span<const std::string_view> precisions() { return kPrecisions; }

std::unique_ptr<HostSimulation> Bench::on_host(const Model& model, const Solver& solver,
                                               const std::string& precision) const {
  return native ? make_native_simulation(model, solver, precision)
                : make_host_reference(model, solver, precision);
}

Bench Bench::without_device(bool native) {
  if (!native) return {.device = nullptr, .label = "CPU reference"};
  return {.device = nullptr,
          .label = fmt::format("native ({})", native::find_kernels().name),
          .pipelines = nullptr,
          .native = true};
}

std::string unavailable(const Bench& bench, const Model& model, const Solver& solver,
                        std::string_view precision) {
  if (std::string lacks = what_solver_lacks(model, solver); !lacks.empty()) return lacks;
  if (precision == "f32k" && !has_compensated(solver)) return "has no form with compensated positions";
  if (bench.device == nullptr) return "";
  if (!solver.on_gpu) return "runs on the CPU reference only";
  return precision == "f64" && !bench.device->info().float64 ? "the device has no float64" : "";
}

Point measure(const Bench& bench, const Model& model, const Setting& setting, const Reference& reference,
              const std::vector<glm::dvec3>& equilibrium, const MeasureOptions& options, const Stop& stop) {
  const double time_s = reference.frames.back().time_s;
  Point point{.setting = setting, .nx = model.grid.nx, .ny = model.grid.ny};
  Run run(bench, model, setting);
  const State start = run.simulation().read();
  run.warm_up();
  State last;
  const TimedRun first = compared_run(run, reference, time_s, stop, point, last);
  point.wall_clock = run.wall_clock();
  point.springs_per_s = static_cast<double>(first.springs) / first.simulated_s;
  point.springs_per_frame = point.springs_per_s * model.scene.solver.frame_s;
  time_further_runs(run, start, time_s, options, stop, first.ms, first.simulated_s, point);
  if (point.diverged) return point;
  if (!equilibrium.empty()) point.equilibrium_distance_m = rms_to(equilibrium, last);
  if (options.energy_drift) point.energy_drift = energy_drift(bench, model, setting, time_s, stop);
  return point;
}

}  // namespace weft::study
