// A run as a row of states at output frames, on the CPU in double or float, and how far two runs are apart.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "solvers/solver.h"

namespace weft::study {

/// Asked after every frame; true ends the work with Error(Exit::interrupted).
using Stop = std::function<bool()>;

/// The start and every output frame after it.
using Trajectory = std::vector<State>;

/// What to run and how: a solver's name, a precision's, substeps a frame.
struct Setting {
  std::string solver = "leapfrog", precision = "f32";
  std::uint32_t substeps = 1;
  bool operator==(const Setting&) const = default;
};

/// The model as it runs with a setting: its scene's [solver] says so.
Model with_setting(const Model& model, const Setting& setting);

/// Runs on the CPU reference for `time_s` as `--time` means it.
/// @param start  another start than the scene's; of the model's shape
/// @throws Error(Exit::interrupted)
Trajectory run_on_cpu(const Model& model, const Setting& setting, double time_s, const Stop& stop,
                      const std::optional<State>& start = {});

/// The error of a run, as every report uses the word: the largest, over output frames, of the root mean
/// square over particles of the distance between the two [m]. Infinite when a number is not finite or when
/// the runs have different lengths.
double trajectory_distance(const Trajectory& a, const Trajectory& b);

/// As rms_distance, infinite instead of NaN.
double frame_distance(const State& a, const State& b);

/// RMS distance at the particles of `coarse` between it and `fine`, another resolution of the same cloth: at
/// a particle's place on the flat cloth the fine state is read directly where it has a particle (2·nx − 1
/// shares every one), else bilinearly.
double resolution_distance(const Grid& coarse_grid, const State& coarse, const Grid& fine_grid,
                           const State& fine);

}  // namespace weft::study
