// The bound behind the largest stable step: row sums of M⁻¹K and of M⁻¹C, in two similar forms.
#pragma once
#include "model/model.h"

namespace weft {

/// Over the free particles, with weighted coefficients:
/// λ = min{ max_i [Σ k(w_i+w_j) + Σ κ(w₋+4w₀+w₊)], max_i w_i[2Σk + Σκ·(4 at an end, 8 in the middle)] },
/// γ = min{ max_i Σ c(w_i+w_j), max_i 2w_iΣc }. Zero when nothing is free or nothing pulls.
StepBound step_bound(const Model& model);

}  // namespace weft
