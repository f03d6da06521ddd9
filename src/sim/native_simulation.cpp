// The plan interpreted by vector kernels: the CPU's fast path, with the reference's bits.
#include "sim/native_simulation.h"

#include <algorithm>

#include "passes/passes.h"
#include "sim/cpu_simulation.h"

namespace weft {
namespace {

class NativeSimulation final : public CpuSimulation<float> {
 public:
  NativeSimulation(const Model& model, const Solver& solver, const native::EngineOptions& options)
      : CpuSimulation(model, solver, "f32"), engine_(model_, plan_, options) {
    write(start_state(model_));
  }

  std::string device_name() const override {
    const std::uint32_t threads = engine_.threads();
    return fmt::format("native ({}, {} {})", engine_.kernels().name, threads,
                       threads == 1 ? "thread" : "threads");
  }
  std::uint64_t bytes_allocated() const override {
    return CpuSimulation::bytes_allocated() + engine_.bytes();
  }

  void begin_frame(double frame_s, std::uint32_t substeps) override {
    CpuSimulation::begin_frame(frame_s, substeps);
    table_ = native::KickTable(model_, frame_.rows);
  }

  void write_drawn(const native::SurfaceTarget& target) override { engine_.write_surface(target); }

 private:
  void run_substeps(std::uint32_t first, std::uint32_t count) override {
    const Clock::time_point began = Clock::now();
    engine_.sweep(table_, first, count);
    const auto in_substep = [](const PlanStep& step) { return step.block == Block::substep; };
    const auto passes = static_cast<double>(std::ranges::count_if(plan_.steps, in_substep));
    const double ms = ms_since(began) / passes;  // they run into each other: each counts alike
    for (const PlanStep& step : plan_.steps)
      if (in_substep(step)) this->count(step, count, ms);
  }

  /// The closing kick and normals by the kernels; what else stands there by its mirror, over the buffers.
  void run_frame_end() override {
    for (const PlanStep& step : plan_.steps) {
      if (step.block != Block::frame_end || !step.pass->swaps_state) continue;
      const Clock::time_point began = Clock::now();
      engine_.sweep(table_, frame_.substeps, 1);
      count(step, 1, ms_since(began));
    }
    for (const PlanStep& step : plan_.steps) {
      if (step.block != Block::frame_end || step.pass != &normals) continue;
      const Clock::time_point began = Clock::now();
      fetch_state();
      count(step, 1, ms_since(began));
    }
    for (const PlanStep& step : plan_.steps)
      if (step.block == Block::frame_end && !step.pass->swaps_state && step.pass != &normals)
        run_step(step, frame_.substeps);
  }

  void model_changed() override { engine_.adopt(model_, plan_); }
  void buffers_written() override { engine_.load(buffers_); }

  void fetch_state() override {
    const auto floats = [&](BufferId id) { return reinterpret_cast<float*>(buffers_[id].data()); };
    engine_.write_surface({floats(BufferId::position), floats(BufferId::normal), floats(BufferId::velocity)});
  }

  native::Engine engine_;
  native::KickTable table_;
};

}  // namespace

std::string native_lacks(const Model& model, const Solver& solver, const std::string& precision) {
  return native::unsupported(compile_plan(model, solver, precision));
}

bool native_by_default(std::span<const gpu::DeviceInfo> ranked) {
  const auto usable = std::ranges::find_if(ranked, [](const auto& info) { return info.unusable.empty(); });
  return usable != ranked.end() && usable->software;
}

std::unique_ptr<HostSimulation> make_native_simulation(const Model& model, const Solver& solver,
                                                       const std::string& precision,
                                                       const native::EngineOptions& options) {
  if (!native_lacks(model, solver, precision).empty()) return make_host_reference(model, solver, precision);
  return std::make_unique<NativeSimulation>(model, solver, options);
}

}  // namespace weft
