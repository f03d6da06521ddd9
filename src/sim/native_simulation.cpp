// The plan interpreted by vector kernels: the CPU's fast path, with the reference's bits.
#include "sim/native_simulation.h"

#include "core/error.h"
#include "model/speed_budget.h"
#include "native/engine.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "plan/buffers.h"
#include "sim/frame_log.h"

namespace weft {
namespace {

class NativeSimulation final : public Simulation {
 public:
  NativeSimulation(const Model& model, const Solver& solver, const native::EngineOptions& options)
      : model_(model),
        plan_(compile_plan(model_, solver, "f32")),
        engine_(model_, constants_of_integrate(), options) {
    size_buffers(plan_, model_, buffers_);
    write(start_state(model_));
  }

  const Model& model() const override { return model_; }
  const Plan& plan() const override { return plan_; }
  std::string device_name() const override {
    const std::uint32_t threads = engine_.threads();
    return fmt::format("native ({}, {} {})", engine_.kernels().name, threads,
                       threads == 1 ? "thread" : "threads");
  }
  double time_s() const override { return time_s_; }

  State read() override {
    State state;
    engine_.store(state);
    state.time_s = time_s_;
    return state;
  }

  void write(const State& state) override {
    if (state.position.size() != model_.grid.count() || state.velocity.size() != model_.grid.count())
      throw error(Exit::internal, "a state of {} particles does not fit a cloth of {}", state.position.size(),
                  model_.grid.count());
    engine_.load(state);
    load_state(model_, state, buffers_);
    time_s_ = state.time_s;
    budget_ = SpeedBudget(model_, state, false);
    log_.begin(time_s_);
    buffers_.words_of(BufferId::watch_state).assign(shared::kWatchStateWords, 0);
    for (const PlanStep& step : plan_.steps)
      if (watches(*step.pass)) run_mirror(step, KickDrift{}, 0);
    log_.look(buffers_.words_of(BufferId::watch_state));
  }

  FrameStats advance(double frame_s, std::uint32_t substeps) override {
    const std::vector<KickDrift> rows = plan_.solver->schedule(time_s_, frame_s, substeps);
    const native::KickTable table(model_, rows);
    FrameStats stats{.substeps = substeps};
    std::uint32_t sweeps = 0;
    for (const PlanStep& step : plan_.steps) {
      const std::uint32_t times = step.block == Block::substep ? substeps : 1;
      if (step.pass == &integrate) sweeps += times;
      stats.dispatches += times;
      stats.spring_evaluations += times * step.spring_evaluations;
    }
    budget_.elapse(model_.scene, frame_s, substeps);
    engine_.sweep(table.kicks().first(sweeps));
    time_s_ = frame_end_s(time_s_, frame_s);
    log_.end_frame(time_s_, frame_s, substeps);
    finish_frame(rows, substeps);
    log_.look(buffers_.words_of(BufferId::watch_state));
    return stats;
  }

  std::optional<Divergence> divergence() const override { return log_.divergence(); }

  std::optional<State> last_good() override {
    if (!log_.sound_time_s()) return std::nullopt;
    HostBuffers<float> kept;
    kept[BufferId::position] = buffers_[BufferId::kept_position];
    kept[BufferId::velocity] = buffers_[BufferId::kept_velocity];
    return store_state(kept, *log_.sound_time_s());
  }

  std::optional<SelfCollisionReport> self_collision() override { return std::nullopt; }
  std::uint64_t bytes_allocated() const override {
    std::uint64_t bytes = engine_.bytes();
    for (const auto& buffer : buffers_.vec4) bytes += buffer.size() * sizeof(buffer[0]);
    for (const auto& buffer : buffers_.words) bytes += buffer.size() * sizeof(buffer[0]);
    return bytes;
  }

 private:
  std::span<const Constant> constants_of_integrate() const {
    for (const PlanStep& step : plan_.steps)
      if (step.pass == &integrate) return step.constants;
    throw error(Exit::internal, "the plan of {} has no integrate", plan_.solver->name);
  }

  /// Normals by the kernel; what else stands at the frame's end by its mirror, over the buffers it reads.
  void finish_frame(const std::vector<KickDrift>& rows, std::uint32_t substeps) {
    static constexpr KickDrift kNone;
    const auto floats = [&](BufferId id) { return reinterpret_cast<float*>(buffers_[id].data()); };
    engine_.write_surface({floats(BufferId::position), floats(BufferId::normal), floats(BufferId::velocity)});
    for (const PlanStep& step : plan_.steps) {
      if (step.block != Block::frame_end || step.pass == &integrate || step.pass == &normals) continue;
      const std::uint32_t row = plan_.table_row(step, substeps);
      run_mirror(step, row < rows.size() ? rows[row] : kNone, row);
    }
  }

  void run_mirror(const PlanStep& step, const KickDrift& row, std::uint32_t row_index) {
    step.pass->mirror_f32({model_, step.constants, row, row_index, step.item, budget_.allowed_m_s()},
                          buffers_);
  }

  Model model_;
  Plan plan_;
  native::Engine engine_;
  HostBuffers<float> buffers_;
  SpeedBudget budget_{model_, start_state(model_), false};
  FrameLog log_;
  double time_s_ = 0.0;
};

}  // namespace

std::string native_lacks(const Model& model, const Solver& solver, const std::string& precision) {
  return native::unsupported(compile_plan(model, solver, precision));
}

std::unique_ptr<Simulation> make_native_simulation(const Model& model, const Solver& solver,
                                                   const std::string& precision,
                                                   const native::EngineOptions& options) {
  if (!native_lacks(model, solver, precision).empty()) return make_cpu_simulation(model, solver, precision);
  return std::make_unique<NativeSimulation>(model, solver, options);
}

}  // namespace weft
