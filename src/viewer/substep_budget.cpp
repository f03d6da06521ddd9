// The budget in words, and when XPBD takes over and gives back.
#include "viewer/substep_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weft {
namespace {

// Of the work that fitted when the scene's solver was left: below it that solver comes back. Less than 1, or
// the two would take turns.
constexpr double kComeBack = 0.8;

}  // namespace

std::uint32_t substep_budget(const Pace& pace) {
  if (!pace.slow) return pace.needed;
  const double share = std::clamp(pace.real_time_factor / pace.wanted_speed, 0.0, 1.0);
  return static_cast<std::uint32_t>(std::floor(share * pace.needed));
}

std::string factor_text(double factor) {
  return factor >= 0.095 || factor == 0.0 ? fmt::format("{:.2f}", factor) : fmt::format("{:.2g}", factor);
}

std::string share_of_time_text(double frame_ms, double allowed_ms) {
  return frame_ms > 0.0 ? fmt::format("{:.0f} % of the time", 100.0 * frame_ms / allowed_ms) : "";
}

std::string slow_motion_text(const Pace& pace) {
  if (!pace.slow) return {};
  return fmt::format("{} x real time: {} substeps needed, budget {}", factor_text(pace.real_time_factor),
                     pace.needed, substep_budget(pace));
}

std::string why_no_stand_in(const Scene& scene) {
  if (scene.solver.name == "xpbd") return "it runs already";
  if (scene.self_collision) return "it has no self-collision";
  return {};
}

std::optional<Scene> XpbdStandIn::look(const Scene& running, const Pace& pace, std::uint64_t particles,
                                       std::uint32_t own_needed) {
  if (own_ && running.solver.name != "xpbd") own_.reset();  // the user chose a solver meanwhile
  Scene next = running;
  if (own_) {
    const double fitted = static_cast<double>(own_->budget) * static_cast<double>(own_->particles);
    const double wanted = static_cast<double>(own_needed) * static_cast<double>(particles);
    if (allowed_ && wanted > kComeBack * fitted) return std::nullopt;
    next.solver = own_->solver;
    own_.reset();
    return next;
  }
  if (!allowed_ || !pace.slow || !why_no_stand_in(running).empty()) return std::nullopt;
  own_ = Own{running.solver, pace.needed, substep_budget(pace), particles};
  next.solver.name = "xpbd";
  next.solver.substeps = 0;
  if (next.solver.precision == "f32k") next.solver.precision = "f32";  // it has no compensated form
  return next;
}

std::string XpbdStandIn::text(double max_stretch) const {
  if (!own_) return {};
  return fmt::format("xpbd in place of {}: {} substeps needed, budget {}; largest stretch {:.1f} %",
                     own_->solver.name, own_->needed, own_->budget, 100.0 * max_stretch);
}

}  // namespace weft
