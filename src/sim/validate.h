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
  bool every_kernel = true;               ///< of those that fit the device; else the direct one alone
  bool assume_inexact = false;  ///< judge a software device, too, by the law for those that round otherwise
};

/// One comparison: a buffer after a pass, or position and velocity after steps in lockstep.
struct ValidationRow {
  /// The pass ("integrate", "integrate, kernel strip", "integrate, kernel bands, 4 substeps"), or "lockstep",
  /// "lockstep, kernel strip".
  std::string check;
  std::string
      state;  ///< "start", "2 frames on", "shaken", "in contact"; for lockstep "100 substeps", "2 frames"
  std::string buffer;  ///< dictionary name
  double max_abs = 0;  ///< largest difference, in the buffer's unit
  double rms = 0;
  std::uint64_t max_ulp = 0;  ///< −0 and +0 agree
  double bias = 0;            ///< largest component of the mean difference
  double tolerance = 0;       ///< allowed max_abs; 0 where the device must be exact
  bool ok = false;
  std::string verdict;  ///< "exact", "within tolerance", "over tolerance", "biased", "untouched", "touched",
                        ///< "not finite"
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
/// pass runs once on the device and once as its mirror of the scene's precision; outputs are compared and all
/// other buffers must keep every bit. `integrate` is checked so with each kind of kernel that the device can
/// run. Then both run the same frames, again with each kernel, and are compared.
///
/// Software devices must agree to the bit. Others divide and take roots a few ulp off, and are held to what
/// float itself loses on the very same work: the float mirror against the double mirror gives a largest and a
/// root mean square error, and the device may stray from the float mirror 16 and 8 times as far. Rounding
/// errors of forces between particles cancel in pairs, so the mean difference has a much narrower allowance
/// (see allowance.h); a wrong gravity or wind, lost below the rounding of stiff springs in
/// every single particle, shows there. Lockstep is judged by the same two factors, against the double
/// reference after the same steps. In f64 the device is held against the double mirror, to all these
/// allowances times 2^-29, the ratio of double's rounding to float's.
/// @throws Error(Exit::usage) when `perturb` names no constant that this scene's plan has on.
ValidationReport validate(gpu::Device&, const Model&, const Solver&, const ValidationOptions& = {});

}  // namespace weft
