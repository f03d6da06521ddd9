// What fits is told with its numbers; what does not, with how much is missing.
#include "viewer/setting_choice.h"

#include <fmt/format.h>

#include "study/choose.h"

namespace weft {
namespace {

std::string numbers(const study::Point& p, double frame_s) {
  return fmt::format("{}: error {:.2e} m, {:.3g} ms a frame", setting_text(p.setting), p.error_m,
                     study::ms_per_frame(p, frame_s));
}

SettingChoice for_error(const std::vector<study::Point>& points, double error_m, double frame_s) {
  if (const auto point = study::choose_for_error(points, error_m))
    return {point, "chosen: " + numbers(*point, frame_s)};
  const study::Point best = *study::most_accurate(points);
  return {{},
          fmt::format("none errs less than {:.2g} m; the most accurate misses it by {:.2g} m: {}", error_m,
                      best.error_m - error_m, numbers(best, frame_s))};
}

SettingChoice for_budget(const std::vector<study::Point>& points, double budget_ms, double frame_s) {
  if (const auto point = study::choose_for_budget(points, budget_ms, frame_s))
    return {point, "chosen: " + numbers(*point, frame_s)};
  const study::Point cheapest = *study::cheapest(points);
  return {{},
          fmt::format("none fits {:.3g} ms; the cheapest misses it by {:.3g} ms: {}", budget_ms,
                      study::ms_per_frame(cheapest, frame_s) - budget_ms, numbers(cheapest, frame_s))};
}

}  // namespace

SettingChoice choose_setting(const study::Study& study, std::uint32_t nx, const SettingWish& wish) {
  if (wish.kind == WishKind::by_hand) return {};
  const std::vector<study::Point> points = study.promises_at(nx);
  if (!study::most_accurate(points)) return {{}, "every setting of the study diverged; none can be chosen"};
  if (wish.kind == WishKind::error) return for_error(points, wish.error_m, study.frame_s);
  return for_budget(points, wish.budget_ms, study.frame_s);
}

study::Setting setting_of(const Scene& scene, std::uint32_t substeps_running) {
  return {scene.solver.name, scene.solver.precision,
          scene.solver.substeps > 0 ? scene.solver.substeps : substeps_running};
}

void set_setting(const study::Setting& setting, Scene& scene) {
  scene.solver.name = setting.solver;
  scene.solver.precision = setting.precision;
  scene.solver.substeps = setting.substeps;
}

std::string setting_text(const study::Setting& setting) {
  return fmt::format("{} {}, {} substeps", setting.solver, setting.precision, setting.substeps);
}

}  // namespace weft
