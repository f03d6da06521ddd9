// Every pass there is, one line each. Explicit list, no self-registration.
#pragma once
#include <span>

#include "passes/pass.h"

namespace weft {

extern const Pass integrate;  ///< forces, kick, drift, contact: one substep
extern const Pass normals;    ///< vertex normals from the adjacent triangles

/// All of them; `validate` walks this list.
std::span<const Pass* const> passes();

}  // namespace weft
