// The plan interpreted on the host, step by step, by the passes' mirrors in float or double; native takes
// over the steps that it has vector code for.
#pragma once
#include <chrono>

#include "model/speed_budget.h"
#include "passes/host_buffers.h"
#include "sim/frame_log.h"
#include "sim/host_simulation.h"

namespace weft {

template <class T>
class CpuSimulation : public HostSimulation {
 public:
  /// Not yet at any state: whoever makes it writes the first.
  CpuSimulation(const Model& model, const Solver& solver, const std::string& precision);

  const Model& model() const override { return model_; }
  const Plan& plan() const override { return plan_; }
  std::string device_name() const override { return fmt::format("CPU reference ({})", plan_.precision); }
  double time_s() const override { return time_s_; }
  State read() override;
  void write(const State& state) override;
  FrameStats advance(double frame_s, std::uint32_t substeps) override;
  std::optional<Divergence> divergence() const override { return log_.divergence(); }
  std::optional<State> last_good() override;
  std::optional<SelfCollisionReport> self_collision() override;
  std::uint64_t bytes_allocated() const override;

  void begin_frame(double frame_s, std::uint32_t substeps) override;
  bool continue_frame(double wall_s) override;
  FrameStats frame_stats() const override { return frame_.stats; }
  void write_drawn(const native::SurfaceTarget& target) override;
  std::vector<double> step_ms() const override { return finished_ms_; }
  bool adopt(const Model& model) override;
  void place(std::span<const PlacedParticle> particles) override;

 protected:
  using Clock = std::chrono::steady_clock;
  /// The frame being computed.
  struct Frame {
    std::vector<KickDrift> rows;
    std::uint32_t substeps = 0, done = 0;
    double start_s = 0, length_s = 0;
    FrameStats stats;
  };

  virtual void run_frame_start() { run_block(Block::frame_start, 0); }
  virtual void run_substeps(std::uint32_t first, std::uint32_t count);
  /// With positions and velocities in the buffers at the end.
  virtual void run_frame_end() { run_block(Block::frame_end, frame_.substeps); }
  /// model_ and plan_ are others.
  virtual void model_changed() {}
  /// The buffers hold another state.
  virtual void buffers_written() {}
  /// Brings positions and velocities into the buffers, in the middle of a frame too.
  virtual void fetch_state() {}

  void run_block(Block block, std::uint32_t substep);
  void run_step(const PlanStep& step, std::uint32_t substep);
  /// What a mirror of a step sees in a substep of the frame.
  MirrorContext context_of(const PlanStep& step, std::uint32_t substep) const;
  /// Counts what has been computed of a step, and its time.
  void count(const PlanStep& step, std::uint32_t times, double ms);
  static double ms_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
  }

  Model model_;
  Plan plan_;
  HostBuffers<T> buffers_;
  Frame frame_;
  bool under_way_ = false;

 private:
  void end_frame();

  SpeedBudget budget_;
  FrameLog log_;
  double time_s_ = 0.0, hand_m_s_ = 0.0;
  double substep_s_ = 0.0;  ///< wall time of one, smoothed
  std::vector<double> step_ms_, finished_ms_;
};

/// What is drawn of a cloth that tears, from the positions and broken links in the buffers: the normals of
/// the triangles that are whole, and the list of indices where the target has a place for it.
void write_torn_surface(const Model& model, HostBuffers<float>& buffers, const native::SurfaceTarget& target);

}  // namespace weft
