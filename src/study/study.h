// A study: every solver × substeps × precision × resolution of one scene on one device, with the floors
// that bound what its errors mean.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/measure.h"

namespace weft::study {

/// What is known of the cloth at one resolution, whatever solver runs.
struct Cloth {
  std::uint32_t nx = 0, ny = 0;
  std::string reference_solver = "rk4";
  std::uint32_t reference_substeps = 0;
  double agreement_m = 0;        ///< of the reference's two finest refinements
  std::string ending;            ///< why refinement ended: "agreed", "no gain", "out of time"
  double twin_m = 0;             ///< drift of a double-precision twin started 1e-7 m apart
  double float_floor_m = 0;      ///< leapfrog in f32 against itself at half the step
  double discretisation_m = -1;  ///< against the cloth at fine_nx; −1: not measured
  std::uint32_t fine_nx = 0;
  std::string equilibrium;  ///< "found", or why the scene has none
};

/// What a study does not hold, or not from its device, and why.
struct Omission {
  std::string what, reason;
};

struct Study {
  std::string title, source, device, date, command;
  double time_s = 0, frame_s = 0;
  bool quick = false;
  bool complete = false;  ///< neither solvers nor precisions were left out by choice
  std::vector<Cloth> cloths;
  std::vector<Omission> left_out;
  std::vector<Omission> by_reference;  ///< what the device left to the CPU reference, and why
  std::vector<Point> points;

  const Cloth* cloth(std::uint32_t nx) const;
  std::vector<Point> points_at(std::uint32_t nx) const;
  /// points_at, no error below what the reference itself is known to: what may be promised of them.
  std::vector<Point> promises_at(std::uint32_t nx) const;
};

std::string to_json(const Study& study);
/// @throws nlohmann::json::exception when it is no study of this format
Study study_from_json(const std::string& text);

struct SweepOptions {
  double time_s = 0.5;
  bool quick = false;
  std::vector<std::uint32_t> resolutions;        ///< empty: the scene's own
  std::vector<std::string> solvers, precisions;  ///< empty: all
  double seconds = 1e9;           ///< no point is begun that is expected to end later than this
  std::filesystem::path records;  ///< folder of finished points; empty: none is kept
  std::string command;            ///< as typed, for the report
};

/// What a sweep tells while it runs, and asks.
struct Watch {
  Stop stop;
  std::function<void(const std::string&)> note;
  std::function<void(std::size_t done, std::size_t total)> progress;
};

/// Substep counts of the sweep, the most telling first: around the automatic count of a solver with a
/// stability limit, around its own automatic count of one without.
std::vector<std::uint32_t> substep_counts(const Model& model, const Solver& solver, bool quick);

/// Runs the sweep. Points found in `records` are taken from there; each finished one is written there at
/// once, whole or not at all.
/// @throws Error(Exit::interrupted); the records stay for the next time
Study run_study(const Bench& bench, const Scene& scene, const SweepOptions& options, const Watch& watch);

/// "2026-01-31 17:05 UTC".
std::string date_now();

}  // namespace weft::study
