// Largest stable steps from the model's bound (docs/physics.md "Largest stable step"), and schedules that
// several solvers share.
#pragma once
#include <vector>

#include "solvers/solver.h"

namespace weft {

/// scale / (γ + √(γ² + factor·λ)) [s]; infinite when λ = γ = 0.
double step_max(const StepBound& bound, double scale, double factor);

/// Leapfrog's frame: kick(½h) drift(h), then n − 1 times kick(h) drift(h), then a closing kick(½h) with
/// drift 0. The kick at start + k·h sees the wind of that time.
std::vector<KickDrift> leapfrog_schedule(double start_s, double frame_s, std::uint32_t substeps);

/// n times kick(h) drift(h): first-order schemes, whose position and velocity belong to the same time anyway.
std::vector<KickDrift> whole_kick_schedule(double start_s, double frame_s, std::uint32_t substeps);

/// One stage of an explicit Runge–Kutta method as a row of the schedule, in units of the step.
struct StageRow {
  double weight;  ///< of the stage's slope in the step: the row's kick
  double reach;   ///< to the next stage: the row's drift; 1 for the last, whose drift is the contact's
  double time;    ///< at which wind is evaluated
};

/// `stages` rows for each of n substeps; air is an ordinary force.
std::vector<KickDrift> runge_kutta_schedule(std::span<const StageRow> stages, double start_s, double frame_s,
                                            std::uint32_t substeps);

/// Leapfrog's and symplectic Euler's rule: h <= 4/(γ + √(γ² + 4λ)).
double leapfrog_step_max(const StepBound& bound);

}  // namespace weft
