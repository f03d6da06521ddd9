// A divergence in words: what happened, and why probably.
#include "sim/divergence.h"

#include <bit>
#include <cmath>
#include <limits>

#include "core/text.h"
#include "model/measures.h"
#include "model/speed_budget.h"
#include "shared/watch.h"

namespace weft {
namespace {

/// What is allowed, of what the scene can have given.
constexpr double kEnergyMargin = SpeedBudget::kMargin * SpeedBudget::kMargin;

}  // namespace

std::optional<Divergence> divergence_in(std::span<const std::uint32_t> watch_state) {
  if (watch_state.empty() || watch_state[shared::kWatchStopped] == 0) return std::nullopt;
  Divergence found;
  found.frame = watch_state[shared::kWatchSound];
  found.particle = watch_state[shared::kWatchParticle];
  if (watch_state[shared::kWatchFastest] >= shared::kWatchInfinite) {
    found.speed_m_s = std::numeric_limits<double>::quiet_NaN();
  } else {
    found.speed_m_s = std::sqrt(std::bit_cast<float>(watch_state[shared::kWatchFastest]));
    found.energy_share = kEnergyMargin * double(watch_state[shared::kWatchEnergy]) / shared::kWatchWhole;
  }
  return found;
}

std::string likely_cause(const Divergence& found, const Model& model, const Plan& plan) {
  const Solver& solver = *plan.solver;
  if (!solver.instability.empty())
    return fmt::format("the solver {} {} (choose another solver, such as leapfrog)", solver.name,
                       solver.instability);
  const double step_max_s = solver.step_max_s(model.bound);
  if (found.substeps > 0 && solver.substeps_default == 0 && found.frame_s / found.substeps > step_max_s)
    return fmt::format(
        "too few substeps: {} is stable up to {:.3g} s here, which a frame of {:.3g} s with {} "
        "exceeds; it needs at least {:.0f} (--substeps auto follows the bound)",
        solver.name, step_max_s, found.frame_s, counted(found.substeps, "substep"),
        std::ceil(found.frame_s / step_max_s));
  if (found.frame == 0) return "the state was not sound when the run began";
  const double ratio = damping_ratios(model).largest;
  if (ratio < kDampingRatioEnough)
    return fmt::format(
        "the step is within the solver's stability bound, but no spring has a damping ratio above {:.2g}, "
        "and "
        "where "
        "cloth is so crushed that neighbours fly over one another within a substep, less than {} lets it "
        "gain "
        "energy (raise material.damping and material.damping_ratio_max, or substeps)",
        ratio, kDampingRatioEnough);
  return "the step is within the solver's stability bound, so that the scene is to be looked at: forces or "
         "speeds beyond what float32 holds, or colliders that crush the cloth";
}

std::string what_happened(const Divergence& found, const Model& model) {
  const std::string who =
      fmt::format("after frame {} (t = {:.6g} s) particle {} (i = {}, j = {})", found.frame, found.time_s,
                  found.particle, found.particle % model.grid.nx, found.particle / model.grid.nx);
  if (std::isnan(found.speed_m_s)) return who + " is not finite";
  return fmt::format(
      "{} moves at {:.3g} m/s, the fastest of a cloth with {}{:.3g} times the most kinetic energy that its "
      "scene can have given it",
      who, found.speed_m_s, found.energy_share > 1.99 * kEnergyMargin ? "more than " : "",
      found.energy_share);
}

Error divergence_error(const Divergence& found, const Model& model, const Plan& plan,
                       const std::string& saved) {
  return error(Exit::diverged, "{}: the simulation diverged: {}; likely cause: {}{}{}", model.scene.source,
               what_happened(found, model), likely_cause(found, model, plan), saved.empty() ? "" : "; ",
               saved);
}

}  // namespace weft
