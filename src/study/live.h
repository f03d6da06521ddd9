// What the accuracy panel shows of a running cloth: where its setting lies in the diagram, an estimate of its
// error while it runs, stretch and energy over time. Nothing here costs anything while it is not called.
#pragma once
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "sim/gpu_simulation.h"
#include "sim/host_simulation.h"
#include "study/kept_studies.h"

namespace weft::study {

/// The error of a setting as a study measured it [m]: that point's, or between two points of the same solver
/// and precision interpolated in log substeps and log error. Nothing outside of what was measured, or beside
/// a diverged point.
/// @param points  of one cloth on one device
std::optional<double> measured_error_m(const std::vector<Point>& points, const Setting& setting);

/// The error of one frame, estimated by running it again from its start with twice the substeps, on a copy.
/// The work is done in parts, so that a window goes on meanwhile.
class LiveError {
 public:
  /// Makes the copy: memory and pipelines of its own. Make it again when model, solver or substeps change.
  /// @param setting  as the running cloth has it
  /// @throws Error(Exit::no_device) when the copy does not fit beside the cloth
  LiveError(const Bench& bench, const Model& model, const Setting& setting);
  ~LiveError();

  /// Begins an estimate; drops one that is under way.
  /// @param before, after  the frame's start and end, as read from the running cloth
  void begin(const State& before, const State& after, double frame_s);
  bool under_way() const { return under_way_; }
  /// The next part of the work, at most about 50 ms. Returns the RMS
  /// distance [m] over particles between the frame's end and its recomputation when that is done; infinite
  /// when a number is not finite.
  std::optional<double> go_on();
  /// Milliseconds that the latest finished estimate took, waiting included: what the panel costs.
  double cost_ms() const { return cost_ms_; }
  /// Of the copy.
  std::uint64_t bytes() const { return copy_->bytes_allocated(); }

 private:
  std::uint32_t substeps_;
  Model model_;
  std::unique_ptr<Simulation> copy_;
  GpuSimulation* on_gpu_ = nullptr;
  HostSimulation* on_host_ = nullptr;
  State after_;
  double cost_ms_ = 0, spent_ms_ = 0;
  bool under_way_ = false;
};

/// Stretch and energy at one time.
struct Sample {
  double time_s = 0, max_stretch = 0, p99_stretch = 0, energy_j = 0;
};

/// The latest samples, the oldest dropped. A time before the last one (a reset) begins anew.
class History {
 public:
  explicit History(std::size_t capacity) : capacity_(capacity) {}
  void add(const Model& model, const State& state);
  void clear() { samples_.clear(); }
  const std::deque<Sample>& samples() const { return samples_; }

 private:
  std::size_t capacity_;
  std::deque<Sample> samples_;
};

}  // namespace weft::study
