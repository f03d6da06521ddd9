// The device against the CPU reference: every pass of a scene's plan by itself, then frames in lockstep.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "model/model.h"
#include "solvers/solver.h"

namespace weft {

struct ValidationOptions {
  std::string perturb;  ///< "pass.constant" to falsify on the device; empty: WEFT_PERTURB, else none
  std::uint32_t lockstep_substeps = 100;  ///< of one frame of that many automatic substeps
  std::uint32_t lockstep_frames = 2;      ///< whole frames after them
};

/// One comparison: a buffer after a pass, or position and velocity after steps in lockstep.
struct ValidationRow {
  std::string check;  ///< the pass ("integrate"), or "lockstep"
  std::string
      state;  ///< "start", "2 frames on", "shaken", "in contact"; for lockstep "100 substeps", "2 frames"
  std::string buffer;  ///< dictionary name
  double max_abs = 0;  ///< largest difference, in the buffer's unit
  double rms = 0;
  std::uint64_t max_ulp = 0;  ///< −0 and +0 agree
  double tolerance = 0;       ///< allowed max_abs; 0 where the device must be exact
  bool ok = false;
  std::string
      verdict;  ///< "exact", "within tolerance", "over tolerance", "untouched", "touched", "not finite"
};

struct ValidationReport {
  std::string device, scene;
  bool exact_required = false;  ///< software devices divide and take roots as IEEE 754 says
  std::string perturbed;        ///< what was falsified, empty when nothing
  std::vector<ValidationRow> rows;
  bool ok() const;
};

/// Compares the device with the reference on this scene.
/// For every step of the plan and every state: outputs are poisoned with NaN, everything else is filled, the
/// pass runs once on the device and once as its float mirror; outputs are compared and all other buffers must
/// keep every bit. Then both run the same frames and are compared.
/// @throws Error(Exit::usage) when `perturb` names no constant that this scene's plan has on.
ValidationReport validate(gpu::Device&, const Model&, const Solver&, const ValidationOptions& = {});

}  // namespace weft
