// A solver: which passes make one substep, how long a stable step is, and the frame's schedule as data.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "passes/pass.h"

namespace weft {

enum class Block { frame_start, substep, frame_end };

/// A pass in a solver's list. In the substep block it repeats n times; elsewhere once.
struct SolverStep {
  const Pass* pass;
  Block block;
  std::uint32_t row = 0;   ///< which of the substep's rows it reads
  std::uint32_t item = 0;  ///< which part of the pass's work it does
};

struct Solver {
  std::string_view name;
  std::string_view about;
  std::string_view source;  ///< paper and equation
  int order;                ///< of convergence, undamped
  bool on_gpu;              ///< false: runs on the CPU reference only, and says so
  std::span<const SolverStep> steps;
  /// Largest stable step [s] for the model's bound; infinite when nothing is stiff.
  double (*step_max_s)(const StepBound&);
  /// The rows of a frame that starts at `start_s` and lasts `frame_s`: rows_per_substep for each of n
  /// substeps, then the closing row where there is one.
  std::vector<KickDrift> (*schedule)(double start_s, double frame_s, std::uint32_t substeps);
  /// Where no step is stable: what happens, "gains energy …"; empty for all others.
  std::string_view instability = {};
  std::uint32_t force_evaluations_per_substep;  ///< and one closing evaluation a frame for kick–drift schemes
  std::uint32_t rows_per_substep = 1;
  std::uint32_t substeps_default =
      0;  ///< the automatic number where stability does not say; 0: step_max_s does
};

/// Every solver, in the order they are listed to people.
std::span<const Solver* const> solvers();

/// @throws Error(Exit::usage) listing the valid names.
const Solver& find_solver(std::string_view name);

/// n = max(1, ⌈frame/(0.9·h_max)⌉), or the solver's default. With scene.solver.substeps set, that number.
/// @throws Error(Exit::usage) when more than 2²⁴ substeps would be needed.
std::uint32_t substeps_per_frame(const Model& model, const Solver& solver);

}  // namespace weft
