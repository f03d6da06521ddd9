// The Plan: an ordered list of dispatches in three blocks, the buffers they need, and what was left out
// and why. The CPU reference and the GPU are two interpreters of it.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/model.h"
#include "passes/pass.h"
#include "solvers/solver.h"

namespace weft {

struct PlanStep {
  const Pass* pass;
  Block block;
  std::uint32_t repeat;  ///< dispatches a frame
  Range range;
  Constants constants;
  std::uint32_t row = 0;                 ///< which of its substep's rows it reads
  std::uint32_t item = 0;                ///< which part of the pass's work it does
  std::uint64_t spring_evaluations = 0;  ///< of one dispatch
  std::uint32_t interval = 1;  ///< in the substep block: runs in substeps 0, interval, 2·interval, …
};

/// Which passes run only where they have something to do (passes/reach.h).
struct Reaching {
  bool bodies = false;  ///< contact with them
  bool links = false;   ///< the strain limit, or tear
  bool tears = false;   ///< integrate_torn, in integrate's place
  bool asked() const { return bodies || links || tears; }
  /// Where in reach_groups the step finds its workgroups; nothing where it always runs.
  std::optional<std::uint32_t> word(const PlanStep& step) const;
};

struct PlanBuffer {
  BufferId id;
  std::uint64_t bytes;
};

struct LeftOut {
  std::string_view effect;
  std::string reason;
};

struct Plan {
  const Solver* solver;
  std::string precision;
  std::uint32_t substeps;           ///< a full frame's
  std::vector<PlanStep> steps;      ///< frame_start, substep, frame_end, in execution order
  std::vector<PlanBuffer> buffers;  ///< ascending binding
  std::vector<LeftOut> left_out;
  std::uint32_t sheet_rows =
      0;  ///< of each of several cloths: constant 30 of the passes that ask for it; 0: one
  Reaching reaching;
  bool spreads = false;      ///< frames may be computed as spread_frame() says, if the cloth stays spread
  bool tells_kicks = false;  ///< `integrate` tells whether a velocity changed by more than the host allows
  bool in_double() const { return precision == "f64"; }
  std::uint64_t bytes() const;
  std::uint64_t dispatches() const;  ///< a full frame's
  std::uint32_t row_count() const {
    return substeps * solver->rows_per_substep + 1;
  }  ///< room for the closing row
  /// The table's row that `step` reads in substep `substep` (its number in the frame; n after the last).
  std::uint32_t table_row(const PlanStep& step, std::uint32_t substep) const {
    return substep * solver->rows_per_substep + step.row;
  }
};

/// Whether the solver runs in f32k: a pass of its substep has a form with compensated positions.
bool has_compensated(const Solver& solver);

/// Which effect of the scene the solver has no passes for; empty when it can run the scene.
std::string what_solver_lacks(const Model& model, const Solver& solver);

/// @param precision  "f32", "f32k" or "f64"; f32k takes each pass's compensated form
/// @throws Error(Exit::usage) listing the precisions, or the solvers that have a compensated form
Plan compile_plan(const Model& model, const Solver& solver, std::string_view precision = "f32");

/// Gives the host every buffer of the plan that mirrors read or write, in its size; collision_state says that
/// no lists are there yet, all else is zero.
template <class T>
void size_buffers(const Plan&, const Model&, HostBuffers<T>&);

std::string describe(const Plan&, const Model&);  ///< for people
std::string to_json(const Plan&, const Model&);   ///< {"steps","buffers","left_out","bytes"}

}  // namespace weft
