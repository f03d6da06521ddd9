// The plan interpreted by vector kernels, and by mirrors where there are none: the CPU's fast path, with the
// reference's bits.
#include "sim/native_simulation.h"

#include <algorithm>
#include <array>
#include <utility>

#include "native/engine.h"
#include "passes/collision.h"
#include "passes/passes.h"
#include "sim/cpu_simulation.h"

namespace weft {
namespace {

class NativeSimulation final : public CpuSimulation<float> {
 public:
  NativeSimulation(const Model& model, const Solver& solver, const native::EngineOptions& options)
      : CpuSimulation(model, solver, "f32"), engine_(model_, plan_, options) {
    buffers_.words_of(BufferId::reach_groups).clear();  // nothing tells the mirrors of contact: they look
    look_at_plan();
    write(start_state(model_));
  }

  std::string device_name() const override {
    const std::uint32_t threads = engine_.threads();
    return fmt::format("native ({}, {} {})", engine_.kernels().name, threads,
                       threads == 1 ? "thread" : "threads");
  }
  std::uint32_t threads() const override { return engine_.threads(); }
  std::uint64_t bytes_allocated() const override {
    return CpuSimulation::bytes_allocated() + engine_.bytes();
  }

  void begin_frame(double frame_s, std::uint32_t substeps) override {
    CpuSimulation::begin_frame(frame_s, substeps);
    table_ = native::KickTable(model_, frame_.rows);
  }

  std::optional<SelfCollisionReport> self_collision() override {
    std::optional<SelfCollisionReport> report = CpuSimulation::self_collision();
    if (report) report->spread_frames = spread_frames_;
    return report;
  }

  void write_drawn(const native::SurfaceTarget& target) override {
    need_rows();
    engine_.write_surface(target);
    if (model_.scene.tearing) write_torn(target);
  }

 private:
  void run_substeps(std::uint32_t first, std::uint32_t count) override {
    if (only_sweeps_) return sweep(Block::substep, first, count);
    if (first == 0) begin_spread_frame();
    if (!spread_frame_) return run_looking(first, count);
    const Clock::time_point began = Clock::now();
    if (engine_.sweep_spread(table_, first, count)) {
      buffers_current_ = false;
      return count_ahead(first, count, ms_since(began));
    }
    take_back_spread_frame();
    run_looking(0, first + count);
  }

  /// As above, with self-collision, strain limit and tearing asked where they may have something to do.
  void run_looking(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t substep = first, end = first + count; substep < end;) {
      const std::uint32_t ahead = sweep_ahead(substep, end - substep);
      if (ahead == 0) run_stages(Block::substep, substep);
      substep += std::max(ahead, 1u);
    }
  }

  void begin_spread_frame() {
    need_rows();
    spread_frame_ = engine_.begin_spread_frame(buffers_);
    stats_at_start_ = frame_.stats;
  }
  void take_back_spread_frame() {
    engine_.take_back_spread_frame(buffers_);
    buffers_current_ = spread_frame_ = false;
    frame_.stats = stats_at_start_;
  }

  /// Somebody else moves pins amid a frame: lists have to be there.
  void place(std::span<const PlacedParticle> particles) override {
    if (spread_frame_ && under_way_ && frame_.done > 0) {
      take_back_spread_frame();
      run_looking(0, frame_.done);
    }
    CpuSimulation::place(particles);
  }

  /// With positions and velocities in the buffers, as watch and keep_sound find them.
  void run_frame_end() override {
    run_stages(Block::frame_end, frame_.substeps);
    spread_frames_ += spread_frame_ ? 1 : 0;
  }

  void run_stages(Block block, std::uint32_t substep) {
    bool swept = false, near_links = true;
    for (const PlanStep& step : plan_.steps) {
      if (step.block != block || (block == Block::substep && substep % step.interval != 0)) continue;
      if (native::means_of(*step.pass, plan_) == native::Means::sweep) {
        if (!std::exchange(swept, true)) {
          sweep(block, substep, 1);
          if (block == Block::substep)
            near_links = engine_.links_are_near(table_.kicks()[plan_.table_row(step, substep)]);
        }
      } else if (!near_links && (step.pass == &strain_limit || step.pass == &tear)) {
        this->count(step, 1, 0.0);
      } else if (native::means_of(*step.pass, plan_) == native::Means::effect) {
        run_effect(step, substep);
      } else if (native::means_of(*step.pass, plan_) == native::Means::look) {
        run_look(step, substep);
      } else if (step.pass == &normals) {
        const Clock::time_point began = Clock::now();
        need_rows();
        write_buffers(floats(BufferId::normal));
        this->count(step, 1, ms_since(began));
      } else {
        run_mirror(step, substep);
      }
    }
  }

  bool is_swept(const PlanStep& step) const {
    return native::means_of(*step.pass, plan_) == native::Means::sweep;
  }

  /// Sweeps as many substeps as have nothing else to do; returns how many. A frame's first has:
  /// self-collision makes its lists.
  std::uint32_t sweep_ahead(std::uint32_t first, std::uint32_t most) {
    const auto has_other_work = [this](const PlanStep& step) {
      return step.block == Block::substep && step.pass->groups_word && has_work(step);
    };
    if (!sweeps_ahead_ || first == 0 || std::ranges::any_of(plan_.steps, has_other_work)) return 0;
    need_rows();
    const Clock::time_point began = Clock::now();
    const std::uint32_t count = engine_.sweep_ahead(table_, first, most);
    if (count == 0) return 0;
    buffers_current_ = false;
    count_ahead(first, count, ms_since(began));
    return count;
  }
  /// All steps of these substeps, of which the sweep's took the time.
  void count_ahead(std::uint32_t first, std::uint32_t count, double ms) {
    count_swept(Block::substep, count, ms);
    const auto up_to = [](std::uint32_t substeps, std::uint32_t interval) {
      return (substeps + interval - 1) / interval;
    };
    for (const PlanStep& step : plan_.steps)
      if (step.block == Block::substep && !is_swept(step))
        this->count(step, up_to(first + count, step.interval) - up_to(first, step.interval), 0.0);
  }

  /// The steps of the block's sweep, in so many substeps.
  void sweep(Block block, std::uint32_t first, std::uint32_t count) {
    need_rows();
    if (contact_follows_) {  // it reads where the drift began
      need_buffers();
      std::swap(buffers_[BufferId::position], buffers_[BufferId::position_next]);
    }
    const Clock::time_point began = Clock::now();
    engine_.sweep(table_, first, count);
    buffers_current_ = false;
    count_swept(block, count, ms_since(began));
  }
  /// The steps run into each other: each counts alike.
  void count_swept(Block block, std::uint32_t count, double all_ms) {
    const auto swept = [&](const PlanStep& step) { return step.block == block && is_swept(step); };
    const double ms = all_ms / static_cast<double>(std::ranges::count_if(plan_.steps, swept));
    for (const PlanStep& step : plan_.steps)
      if (swept(step)) this->count(step, count, ms);
  }

  void run_effect(const PlanStep& step, std::uint32_t substep) {
    const Clock::time_point began = Clock::now();
    need_rows();
    engine_.run(step, table_.kicks()[plan_.table_row(step, substep)]);
    buffers_current_ = false;
    this->count(step, 1, ms_since(began));
  }

  /// Whether a pass that takes its workgroups from a word of collision_state has any.
  bool has_work(const PlanStep& step) const {
    const auto word = step.pass->groups_word;
    return !word || buffers_.words_of(BufferId::collision_state)[*word] != 0;
  }

  void run_look(const PlanStep& step, std::uint32_t substep) {
    const Clock::time_point began = Clock::now();
    if (has_work(step)) {
      need_rows();
      const bool empty =
          step.pass == &cell_count && engine_.make_empty_lists(buffers_, [this] { need_buffers(); });
      if (!empty && native::SelfCollision::reads_buffers(*step.pass)) need_buffers();
      if (!empty && engine_.look(*step.pass, context_of(step, substep), buffers_)) buffers_current_ = false;
    }
    this->count(step, 1, ms_since(began));
  }

  void run_mirror(const PlanStep& step, std::uint32_t substep) {
    if (!has_work(step)) return this->count(step, 1, 0.0);
    need_buffers();
    const RowThreadsInUse threads(engine_.threads_for_mirrors());
    run_step(step, substep);
    const bool moves = step.block == Block::substep || step.pass->swaps_state;
    if (moves && !only_lists(*step.pass)) rows_current_ = false;  // what else ends a frame only looks at it
  }

  /// Whether a pass of self-collision makes lists or weighs contacts and moves nobody.
  static bool only_lists(const Pass& pass) {
    static constexpr std::array kOnlyLists{&cell_count,     &patch_near,   &cell_scan,
                                           &cell_fill,      &cell_sort,    &pair_gather,
                                           &surface_gather, &touch_weight, &surface_touch};
    return std::ranges::count(kOnlyLists, &pass) > 0;
  }

  void model_changed() override {
    engine_.adopt(model_, plan_);
    look_at_plan();
  }
  void buffers_written() override {
    spread_frame_ = false;
    engine_.load(buffers_);
    rows_current_ = buffers_current_ = true;
  }
  void fetch_state() override { need_buffers(); }

  void need_rows() {
    if (!std::exchange(rows_current_, true)) engine_.load(buffers_);
  }
  void need_buffers() {
    if (!std::exchange(buffers_current_, true)) write_buffers(nullptr);
  }
  /// Rows into the buffers; normals too, where they have a place.
  void write_buffers(float* normal) {
    engine_.write_surface({floats(BufferId::position), normal, floats(BufferId::velocity)});
    std::ranges::copy(engine_.broken_links(), buffers_.words_of(BufferId::broken_links).begin());
    buffers_current_ = true;
  }
  float* floats(BufferId id) { return reinterpret_cast<float*>(buffers_[id].data()); }

  void write_torn(const native::SurfaceTarget& target) {
    need_buffers();
    const RowThreadsInUse threads(engine_.threads_for_mirrors());
    write_torn_surface(model_, buffers_, target);
  }

  void look_at_plan() {
    only_sweeps_ = std::ranges::all_of(plan_.steps, [this](const PlanStep& step) {
      return step.block != Block::substep || native::means_of(*step.pass, plan_) == native::Means::sweep;
    });
    sweeps_ahead_ = native::sweep_watches_motion(plan_, model_) ||
                    (native::sweep_watches_links(plan_, model_) &&
                     std::ranges::all_of(plan_.steps, [this](const PlanStep& step) {
                       return step.block != Block::substep || is_swept(step) || step.pass == &strain_limit ||
                              step.pass == &tear;
                     }));
    contact_follows_ = std::ranges::any_of(plan_.steps, [this](const PlanStep& step) {
      return step.pass == &mesh_contact && native::means_of(*step.pass, plan_) == native::Means::mirror;
    });
  }

  native::Engine engine_;
  native::KickTable table_;
  /// Where the latest state is: in the kernels' rows, in the buffers, or in both.
  bool rows_current_ = true, buffers_current_ = true;
  bool only_sweeps_ = false, sweeps_ahead_ = false, contact_follows_ = false;
  std::uint32_t spread_frames_ = 0;
  bool spread_frame_ = false;  ///< the frame under way is swept without looks (Engine::sweep_spread)
  FrameStats stats_at_start_;  ///< of that frame
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
