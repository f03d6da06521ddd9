// A running cloth: the plan interpreted on one device, frame by frame.
#pragma once
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "model/model.h"
#include "plan/plan.h"
#include "sim/divergence.h"

namespace weft {

struct FrameStats {
  std::uint32_t substeps = 0;
  std::uint64_t dispatches = 0;
  std::uint64_t spring_evaluations = 0;
};

/// What self-collision has done since the simulation began.
struct SelfCollisionReport {
  std::uint32_t lists_built = 0;    ///< how often the pair lists were made anew
  std::uint32_t pairs_dropped = 0;  ///< entries that found no room: contacts may have been missed
  std::uint32_t held_back = 0;      ///< how often a particle's motion was cut, so that no layers met
  /// The smallest distance [m] of two surfaces that share no particle, in the latest frame; nothing when all
  /// were farther apart than the lists reach.
  std::optional<double> smallest_gap_m;
  /// Frames that were computed without its passes: the cloth stayed spread out, nowhere folded.
  std::uint32_t spread_frames = 0;
};

class Simulation {
 public:
  virtual ~Simulation() = default;
  virtual const Model& model() const = 0;
  virtual const Plan& plan() const = 0;
  virtual std::string device_name() const = 0;
  virtual double time_s() const = 0;
  /// Advances by one frame of `frame_s` in `substeps` substeps (kick, drift and closing kick as the solver
  /// says).
  virtual FrameStats advance(double frame_s, std::uint32_t substeps) = 0;
  virtual State read() = 0;              ///< waits for the device
  virtual void write(const State&) = 0;  ///< positions, velocities, time
  /// What the watch at the frames' ends has found since the latest write(): nothing while all is sound. Does
  /// not wait; a device's verdict over a frame is known at the latest when the next one has begun, and after
  /// read() or wait().
  virtual std::optional<Divergence> divergence() const = 0;
  /// The state at the end of the latest frame before that; before a divergence, the latest sound one. Nothing
  /// when there never was one. Waits for the device. In f32k without the compensation.
  virtual std::optional<State> last_good() = 0;
  virtual std::uint64_t bytes_allocated() const = 0;
  /// Waits for the device. Nothing when the scene has no [self_collision].
  virtual std::optional<SelfCollisionReport> self_collision() = 0;
};

/// The report in the words of collision_state.
inline SelfCollisionReport report_of(std::span<const std::uint32_t> collision_state) {
  SelfCollisionReport report{collision_state[shared::kListsBuilt], collision_state[shared::kPairsDropped],
                             collision_state[shared::kHeldBack], std::nullopt};
  const std::uint32_t gap = collision_state[shared::kSmallestGap];
  if (gap < shared::kInfinity) report.smallest_gap_m = std::bit_cast<float>(gap);
  return report;
}

/// The CPU reference in float ("f32", and "f32k" with compensated positions) or double ("f64").
/// @throws Error(Exit::usage) for another precision, or one that the solver does not have
std::unique_ptr<Simulation> make_cpu_simulation(const Model&, const Solver&, const std::string& precision);

/// Runs `time_s` seconds: whole frames of scene.solver.frame_s, then one short frame (docs/cli.md).
/// `after_frame` is called with the number of frames done and may return false to stop.
template <class AfterFrame>
void run_for(Simulation& simulation, double time_s, AfterFrame&& after_frame);

/// The frames that `--time S` means: ⌊S/frame + 1e-6⌋ whole ones, then one short one when more is left.
struct FramePlan {
  std::uint64_t whole = 0;
  double rest_s = 0.0;
  std::uint32_t rest_substeps = 0;
};
FramePlan frames_for(double time_s, double frame_s, std::uint32_t substeps);

/// When a frame that starts at `start_s` ends: the whole multiple of `frame_s` where that is meant, so that
/// hours of frames do not add up round-off.
double frame_end_s(double start_s, double frame_s);

template <class AfterFrame>
void run_for(Simulation& simulation, double time_s, AfterFrame&& after_frame) {
  const double frame_s = simulation.model().scene.solver.frame_s;
  const std::uint32_t n = simulation.plan().substeps;
  const FramePlan frames = frames_for(time_s, frame_s, n);
  const std::uint64_t total = frames.whole + (frames.rest_substeps > 0 ? 1 : 0);
  for (std::uint64_t f = 0; f < total; ++f) {
    const bool whole = f < frames.whole;
    const FrameStats stats =
        simulation.advance(whole ? frame_s : frames.rest_s, whole ? n : frames.rest_substeps);
    if (!after_frame(f + 1, total, stats)) return;
  }
}

}  // namespace weft
