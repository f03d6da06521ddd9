// What a scene expects of itself: its [expect] block held against a state.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"
#include "sim/simulation.h"

namespace weft {

/// One line of [expect] and how the state answers it.
struct Verdict {
  std::string check;      ///< the key: "max_stretch", "lowest_y", …
  double measured = 0.0;  ///< in `unit`
  double limit = 0.0;     ///< what the scene asks for
  bool at_least = false;  ///< measured ≥ limit is asked for, else measured ≤ limit
  std::string unit;       ///< "m", "J", or empty for a ratio
  bool holds = false;     ///< false also for a measurement that is not a number
};

/// When a scene's checks are made [s]: expect.at_time, else the end of a run of `run_s`.
double expect_time_s(const Scene& scene, double run_s);

/// Every key of the model's [expect] block against a state, in the order of the file format. Empty without
/// the block. lowest_y and highest_y bound every particle's height from below and from above [m]; stretches
/// are relative elongations of structural springs; energy_max_j bounds the total energy.
std::vector<Verdict> check_expectations(const Model& model, const State& state);

/// Runs the simulation to the time of its checks (at most `run_s` without expect.at_time) and makes them.
std::vector<Verdict> run_expectations(Simulation& simulation, double run_s);

/// Whether all of them hold; true when there is none.
bool all_hold(const std::vector<Verdict>& verdicts);

/// "max_stretch 0.042 <= 0.1: holds", one line each.
std::string describe(const std::vector<Verdict>& verdicts);

}  // namespace weft
