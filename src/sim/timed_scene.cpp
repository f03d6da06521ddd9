// A device's timestamps tell steps of the frame from those of substeps; the host's clock takes all together.
#include "sim/timed_scene.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <utility>

#include "native/engine_options.h"
#include "sim/gpu_simulation.h"
#include "sim/native_simulation.h"
#include "solvers/solver.h"

namespace weft {
namespace {

/// Particle·substeps below which a run on native is repeated: some milliseconds of it.
constexpr double kRunLeast = 1e6;

/// Of this process, all its threads.
double processor_now_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

class TimedOnGpu final : public TimedScene {
 public:
  TimedOnGpu(gpu::Device& device, const Scene& scene, const std::string& kernel,
             std::shared_ptr<GpuPipelines> pipelines)
      : software_(device.info().software),
        simulation_(GpuSimulation::create(device, build_model(scene), find_solver(scene.solver.name),
                                          {.perturb = {},
                                           .pipelines = std::move(pipelines),
                                           .kernel = fitting_kernel(device, scene, kernel)})) {}
  const Plan& plan() const override { return simulation_->plan(); }
  void write(const State& state) override { simulation_->write(state); }
  void advance(double time_s, std::uint32_t substeps) override { simulation_->advance(time_s, substeps); }
  State read() override { return simulation_->read(); }
  RunTime run(const State& state, double time_s, std::uint32_t substeps) override {
    simulation_->write(state);
    const double began_ms = processor_now_ms();
    latest_ = simulation_->advance(time_s, substeps);
    simulation_->wait();
    RunTime took;
    if (software_) took.processor_ms = processor_now_ms() - began_ms;
    const std::vector<double> steps = simulation_->step_ms();
    for (std::size_t step = 0; step < steps.size(); ++step)
      (plan().steps[step].block == Block::substep ? took.substeps_ms : took.once_ms) += steps[step];
    return took;
  }
  std::uint64_t bytes() const override { return simulation_->bytes_allocated(); }
  std::uint64_t dispatches(std::uint32_t substeps) const override {
    return latest_.substeps == substeps ? latest_.dispatches : simulation_->dispatches_expected(substeps);
  }
  std::string runner() const override { return describe(simulation_->kernel()); }

 private:
  static std::string fitting_kernel(gpu::Device& device, const Scene& scene, const std::string& kernel) {
    if (kernel.empty() || kernel == "auto") return kernel;
    const Plan plan =
        compile_plan(build_model(scene), find_solver(scene.solver.name), scene.solver.precision);
    const auto fitting = fitting_kernel_names(device, plan);
    return std::ranges::find(fitting, kernel) == fitting.end() ? "auto" : kernel;
  }

  bool software_;
  FrameStats latest_;
  std::unique_ptr<GpuSimulation> simulation_;
};

class TimedOnNative final : public TimedScene {
 public:
  TimedOnNative(const Scene& scene, std::uint32_t threads)
      : simulation_(make_native_simulation(build_model(scene), find_solver(scene.solver.name),
                                           scene.solver.precision, {.threads = threads, .vector = {}})) {}
  const Plan& plan() const override { return simulation_->plan(); }
  void write(const State& state) override { simulation_->write(state); }
  void advance(double time_s, std::uint32_t substeps) override { simulation_->advance(time_s, substeps); }
  State read() override { return simulation_->read(); }
  RunTime run(const State& state, double time_s, std::uint32_t substeps) override {
    const double work = static_cast<double>(simulation_->model().grid.count()) * substeps;
    const auto repeats = static_cast<std::uint32_t>(std::clamp(std::ceil(kRunLeast / work), 1.0, 64.0));
    RunTime took{.processor_ms = 0.0};
    for (std::uint32_t repeat = 0; repeat < repeats; ++repeat) {
      simulation_->write(state);
      const double processor_ms = processor_now_ms();
      const auto began = std::chrono::steady_clock::now();
      simulation_->advance(time_s, substeps);
      took.substeps_ms +=
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count() /
          repeats;
      took.processor_ms += (processor_now_ms() - processor_ms) / repeats;
    }
    return took;
  }
  std::uint64_t bytes() const override { return simulation_->bytes_allocated(); }
  /// Steps of the plan, each as often as it stands in a frame.
  std::uint64_t dispatches(std::uint32_t) const override { return plan().dispatches(); }
  std::string runner() const override { return simulation_->device_name(); }
  std::uint32_t threads() const override { return simulation_->threads(); }

 private:
  std::unique_ptr<HostSimulation> simulation_;
};

}  // namespace

std::unique_ptr<TimedScene> time_on_gpu(gpu::Device& device, const Scene& scene, const std::string& kernel,
                                        std::shared_ptr<GpuPipelines> pipelines) {
  return std::make_unique<TimedOnGpu>(device, scene, kernel, std::move(pipelines));
}

std::unique_ptr<TimedScene> time_on_native(const Scene& scene, std::uint32_t threads) {
  return std::make_unique<TimedOnNative>(scene, threads);
}

}  // namespace weft
