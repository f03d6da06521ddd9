// A frame in which a cloth with self-collision stays spread out over a plane, nowhere folded: without the
// section's passes, and with looks that prove it. A device computes such a frame first and takes it back
// where the looks do not; native sweeps it with looks of its own.
#pragma once
#include <cstdint>

#include "plan/plan.h"

namespace weft {

/// Whether frames of the plan may be computed so: in float, one cloth, and nothing but `integrate` moves it.
bool has_spread_frames(const Plan& plan, const Model& model);

/// Such a frame of a plan that has them, with a look in the first substep, in every `interval`-th after it
/// and at the frame's end, where the watch for divergence comes last. Its buffers are the plan's.
Plan spread_frame(const Plan& plan, const Model& model, std::uint32_t interval);

}  // namespace weft
