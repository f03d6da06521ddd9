// Step rules and shared schedules.
#include "solvers/step_rules.h"

#include <cmath>
#include <limits>

namespace weft {

double step_max(const StepBound& bound, double scale, double factor) {
  const double gamma = bound.gamma_1_s;
  const double rate = gamma + std::sqrt(gamma * gamma + factor * bound.lambda_1_s2);
  return rate > 0.0 ? scale / rate : std::numeric_limits<double>::infinity();
}

std::vector<KickDrift> leapfrog_schedule(double start_s, double frame_s, std::uint32_t substeps) {
  const double h = frame_s / substeps;
  std::vector<KickDrift> rows;
  rows.reserve(std::size_t{substeps} + 1);
  for (std::uint32_t k = 0; k <= substeps; ++k) {
    const double time_s = start_s + k * h;
    const bool half = k == 0 || k == substeps;
    rows.push_back({half ? 0.5 * h : h, k == substeps ? 0.0 : h, time_s, time_s});
  }
  return rows;
}

std::vector<KickDrift> whole_kick_schedule(double start_s, double frame_s, std::uint32_t substeps) {
  const double h = frame_s / substeps;
  std::vector<KickDrift> rows;
  rows.reserve(substeps);
  for (std::uint32_t k = 0; k < substeps; ++k) rows.push_back({h, h, start_s + k * h, start_s + k * h});
  return rows;
}

std::vector<KickDrift> runge_kutta_schedule(std::span<const StageRow> stages, double start_s, double frame_s,
                                            std::uint32_t substeps) {
  const double h = frame_s / substeps;
  std::vector<KickDrift> rows;
  rows.reserve(stages.size() * substeps);
  for (std::uint32_t k = 0; k < substeps; ++k) {
    const double time_s = start_s + k * h;
    for (const StageRow& stage : stages)
      rows.push_back({.kick_s = stage.weight * h,
                      .drift_s = stage.reach * h,
                      .kick_time_s = time_s + stage.time * h,
                      .drift_time_s = time_s,
                      .plain_air = true});
  }
  return rows;
}

double leapfrog_step_max(const StepBound& bound) { return step_max(bound, 4.0, 4.0); }

}  // namespace weft
