// Wall time on purpose: it is what a machine without a GPU has to spend, and the one clock all backends
// share.
#include "sim/backend_bench.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "core/cores.h"
#include "core/error.h"
#include "native/bands.h"
#include "native/features.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"

namespace weft {
namespace {

using BenchClock = std::chrono::steady_clock;

double seconds_since(BenchClock::time_point began) {
  return std::chrono::duration<double>(BenchClock::now() - began).count();
}

/// What a square root and a division of one float take on one core, with the widest vectors.
double root_and_division_ns(const native::Kernels& kernels) {
  constexpr std::uint64_t kRepeats = 200'000;
  const auto began = BenchClock::now();
  const volatile float kept = kernels.divide(kRepeats);
  static_cast<void>(kept);
  return seconds_since(began) * 1e9 / static_cast<double>(kRepeats * kernels.lanes);
}

/// Other programs: a thread a core that computes until this goes out of scope.
class BusyCores {
 public:
  explicit BusyCores(std::uint32_t count) {
    for (std::uint32_t k = 0; k < count; ++k)
      threads_.emplace_back([this] {
        while (!stopping_.load(std::memory_order_relaxed)) native::find_kernels().divide(1000);
      });
  }
  ~BusyCores() {
    stopping_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  BusyCores(const BusyCores&) = delete;
  BusyCores& operator=(const BusyCores&) = delete;

 private:
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> threads_;
};

/// One backend with its times so far.
class Contender {
 public:
  /// @param busy  cores to keep busy during its turns
  Contender(std::unique_ptr<Simulation> simulation, std::uint32_t threads, GpuSimulation* on_gpu,
            std::uint32_t busy = 0)
      : simulation_(std::move(simulation)), on_gpu_(on_gpu), threads_(threads), busy_(busy) {
    const Plan& plan = simulation_->plan();
    substep_s_ = simulation_->model().scene.solver.frame_s / plan.substeps;
    run(2);  // pipelines and caches
    const double one_s = run(std::max(2u, plan.substeps / 8)) / std::max(2u, plan.substeps / 8);
    expected_s_ = one_s;
  }

  void turn(double repetition_s) {
    const double fits = std::clamp(repetition_s / expected_s_, 2.0, 4096.0);
    const auto substeps = static_cast<std::uint32_t>(fits);
    const BusyCores neighbours(busy_);
    if (busy_ > 0) run(substeps);  // meets them before it is timed
    times_s_.push_back(run(substeps) / substeps);
  }

  BackendRow result(double divider_ns) const {
    const Model& model = simulation_->model();
    BackendRow row{.backend = simulation_->device_name(),
                   .beside_busy = busy_ > 0,
                   .nx = model.grid.nx,
                   .ny = model.grid.ny,
                   .threads = threads_,
                   .substeps = simulation_->plan().substeps};
    std::vector<double> sorted = times_s_;
    std::ranges::sort(sorted);
    const double to_ns = 1e9 / model.grid.count();
    row.ns_best = sorted.front() * to_ns;
    row.ns_median = sorted[sorted.size() / 2] * to_ns;
    row.frame_ms = sorted.front() * 1e3 * row.substeps;
    if (on_gpu_ != nullptr) row.kernel = weft::describe(on_gpu_->kernel().kernel);
    const bool sweeps = simulation_->plan().solver->name != "xpbd";  // its springs divide otherwise
    if (threads_ > 0 && busy_ == 0 && sweeps) {
      const double cores = std::min(threads_, usable_cores());
      row.divider_share = divider_ns * pairs_a_particle() / (row.ns_best * cores);
    }
    return row;
  }

 private:
  /// In frames of at most a plan's substeps, which are what a device has room for.
  double run(std::uint32_t substeps) {
    const auto began = BenchClock::now();
    for (std::uint32_t left = substeps; left > 0;) {
      const std::uint32_t count = std::min(left, simulation_->plan().substeps);
      simulation_->advance(substep_s_ * count, count);
      left -= count;
    }
    if (on_gpu_ != nullptr) on_gpu_->wait();
    return seconds_since(began);
  }
  double pairs_a_particle() const {
    const Model& model = simulation_->model();
    const bool shear = model.springs[kShearDown].stiffness_n_m > 0.0;
    const bool two_apart = model.springs[kFlexI].stiffness_n_m > 0.0 ||
                           model.springs[kFlexJ].stiffness_n_m > 0.0 || model.bends();
    return 2.0 + (shear ? 2.0 : 0.0) + (two_apart ? 2.0 : 0.0);
  }

  std::unique_ptr<Simulation> simulation_;
  GpuSimulation* on_gpu_;
  std::uint32_t threads_, busy_;
  double substep_s_, expected_s_ = 0;
  std::vector<double> times_s_;
};

/// Each on a cloth of its own.
std::vector<Contender> contenders(gpu::Device* device, const Model& model, std::uint32_t cores,
                                  const std::string& kernel) {
  const Solver& solver = find_solver(model.scene.solver.name);
  const std::string& precision = model.scene.solver.precision;
  const auto native_in = [&](std::uint32_t threads) {
    return make_native_simulation(model, solver, precision, {.threads = threads, .vector = {}});
  };
  std::vector<Contender> all;
  const auto most = std::max(1u, std::min(cores, model.grid.ny / native::kRowsPerBandMin));
  all.emplace_back(native_in(0), most, nullptr);
  all.emplace_back(native_in(1), 1, nullptr);
  all.emplace_back(native_in(2 * cores), 2 * cores, nullptr);
  all.emplace_back(native_in(0), most, nullptr, cores);
  all.emplace_back(native_in(1), 1, nullptr, cores);
  if (device != nullptr) {
    auto on_gpu = GpuSimulation::create(*device, model, solver, {.kernel = kernel.empty() ? "auto" : kernel});
    GpuSimulation* const watched = on_gpu.get();
    all.emplace_back(std::move(on_gpu), 0, watched);
  }
  all.emplace_back(make_cpu_simulation(model, solver, precision), 0, nullptr);
  return all;
}

}  // namespace

BackendBenchReport bench_backends(gpu::Device* device, const Scene& scene,
                                  const BackendBenchOptions& options) {
  const native::Kernels& kernels = native::find_kernels();
  BackendBenchReport report{.scene = scene.title,
                            .solver = scene.solver.name,
                            .cores = usable_cores(),
                            .repetitions = options.repetitions,
                            .root_and_division_ns = root_and_division_ns(kernels)};
  for (const std::uint32_t resolution : options.resolutions) {
    Scene sized = scene;
    sized.cloth.resolution = resolution;
    sized.solver.substeps = 0;
    const Model model = build_model(sized);
    const std::string lacks = native_lacks(model, find_solver(sized.solver.name), sized.solver.precision);
    if (!lacks.empty())
      throw error(Exit::usage, "{}: {}; bench --device native needs a scene that native runs", scene.source,
                  lacks);
    std::vector<Contender> all = contenders(device, model, report.cores, options.kernel);
    for (std::uint32_t repetition = 0; repetition < options.repetitions; ++repetition) {
      report.root_and_division_ns = std::min(report.root_and_division_ns, root_and_division_ns(kernels));
      for (Contender& contender : all) contender.turn(options.repetition_s);
    }
    for (const Contender& contender : all)
      report.rows.push_back(contender.result(report.root_and_division_ns));
  }
  return report;
}

}  // namespace weft
