// The plan interpreted by the passes' CPU mirrors, in float or double: the reference that the GPU is held to.
#include "core/error.h"
#include "model/speed_budget.h"
#include "passes/passes.h"
#include "passes/tables.h"
#include "plan/buffers.h"
#include "sim/frame_log.h"
#include "sim/simulation.h"

namespace weft {
namespace {

template <class T>
struct Precision;

template <>
struct Precision<float> {
  static auto mirror(const Pass& pass) { return pass.mirror_f32; }
};

template <>
struct Precision<double> {
  static auto mirror(const Pass& pass) { return pass.mirror_f64; }
};

template <class T>
class CpuSimulation final : public Simulation {
 public:
  CpuSimulation(const Model& model, const Solver& solver, const std::string& precision)
      : model_(model), plan_(compile_plan(model_, solver, precision)) {
    size_buffers(plan_, model_, buffers_);
    write(start_state(model_));
  }

  const Model& model() const override { return model_; }
  const Plan& plan() const override { return plan_; }
  std::string device_name() const override { return fmt::format("CPU reference ({})", plan_.precision); }
  double time_s() const override { return time_s_; }
  State read() override { return store_state(buffers_, time_s_); }

  void write(const State& state) override {
    if (state.position.size() != model_.grid.count() || state.velocity.size() != model_.grid.count())
      throw error(Exit::internal, "a state of {} particles does not fit a cloth of {}", state.position.size(),
                  model_.grid.count());
    load_state(model_, state, buffers_);
    time_s_ = state.time_s;
    budget_ = SpeedBudget(model_, state, plan_.in_double());
    log_.begin(time_s_);
    buffers_.words_of(BufferId::watch_state).assign(shared::kWatchStateWords, 0);
    FrameStats not_counted;
    for (const PlanStep& step : plan_.steps)
      if (watches(*step.pass)) run_step(step, KickDrift{}, 0, not_counted);
    log_.look(buffers_.words_of(BufferId::watch_state));
  }

  FrameStats advance(double frame_s, std::uint32_t substeps) override {
    const std::vector<KickDrift> rows = plan_.solver->schedule(time_s_, frame_s, substeps);
    FrameStats stats{.substeps = substeps};
    budget_.elapse(model_.scene, frame_s, substeps);
    run_block(Block::frame_start, rows, 0, stats);
    for (std::uint32_t k = 0; k < substeps; ++k) run_block(Block::substep, rows, k, stats);
    time_s_ = frame_end_s(time_s_, frame_s);
    log_.end_frame(time_s_, frame_s, substeps);
    run_block(Block::frame_end, rows, substeps, stats);
    log_.look(buffers_.words_of(BufferId::watch_state));
    return stats;
  }

  std::optional<Divergence> divergence() const override { return log_.divergence(); }

  std::optional<State> last_good() override {
    if (!log_.sound_time_s()) return std::nullopt;
    HostBuffers<T> kept;
    kept[BufferId::position] = buffers_[BufferId::kept_position];
    kept[BufferId::velocity] = buffers_[BufferId::kept_velocity];
    return store_state(kept, *log_.sound_time_s());
  }

  std::optional<SelfCollisionReport> self_collision() override {
    if (!model_.scene.self_collision) return std::nullopt;
    return report_of(buffers_.words_of(BufferId::collision_state));
  }

  std::uint64_t bytes_allocated() const override {
    std::uint64_t bytes = 0;
    for (const auto& buffer : buffers_.vec4) bytes += buffer.size() * sizeof(buffer[0]);
    for (const auto& buffer : buffers_.words) bytes += buffer.size() * sizeof(buffer[0]);
    return bytes;
  }

 private:
  void run_block(Block block, const std::vector<KickDrift>& rows, std::uint32_t substep, FrameStats& stats) {
    static constexpr KickDrift kNone;  // what a step after the last row sees when there is no closing one
    for (const PlanStep& step : plan_.steps) {
      if (step.block != block || (block == Block::substep && substep % step.interval != 0)) continue;
      const std::uint32_t row = plan_.table_row(step, substep);
      run_step(step, row < rows.size() ? rows[row] : kNone, row, stats);
    }
  }

  void run_step(const PlanStep& step, const KickDrift& row, std::uint32_t row_index, FrameStats& stats) {
    Precision<T>::mirror (*step.pass)(
        {model_, step.constants, row, row_index, step.item, budget_.allowed_m_s()}, buffers_);
    if (step.pass->swaps_state) {
      std::swap(buffers_[BufferId::position], buffers_[BufferId::position_next]);
      std::swap(buffers_[BufferId::velocity], buffers_[BufferId::velocity_next]);
    }
    ++stats.dispatches;
    stats.spring_evaluations += step.spring_evaluations;
  }

  Model model_;
  Plan plan_;
  HostBuffers<T> buffers_;
  SpeedBudget budget_{model_, start_state(model_), plan_.in_double()};
  FrameLog log_;
  double time_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Simulation> make_cpu_simulation(const Model& model, const Solver& solver,
                                                const std::string& precision) {
  if (precision == "f64") return std::make_unique<CpuSimulation<double>>(model, solver, precision);
  return std::make_unique<CpuSimulation<float>>(model, solver, precision);
}

}  // namespace weft
