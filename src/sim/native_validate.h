// The vector kernels against the CPU reference, width by width, to the bit.
#pragma once
#include "sim/validate.h"

namespace weft {

/// From every state that `validate` probes a device with, each kernel of this machine and the reference run
/// the same substeps, in one thread and in several, and end with normals; position, velocity and normal must
/// agree to the bit.
/// @throws Error(Exit::usage) when native does not run this solver and precision, or for options.perturb: no
///         constant of a kernel can be falsified
ValidationReport validate_native(const Model&, const Solver&, const ValidationOptions& = {});

}  // namespace weft
