// The states on which a pass is checked: the scene's own, and ones that reach what a quiet start does not.
#pragma once
#include <string>
#include <vector>

#include "model/model.h"
#include "solvers/solver.h"

namespace weft {

struct ProbeState {
  std::string name;
  State state;
};

/// "start"; "2 frames on" by the float reference; "shaken": every particle displaced by up to a tenth of a
/// cell with up to 2 m/s, so that no term is zero; with colliders "in contact", the shaken cloth moved into
/// the first sphere and half of it below the floor. The same numbers on every machine.
std::vector<ProbeState> probe_states(const Model& model, const Solver& solver);

}  // namespace weft
