// The panel's two sliders: a setting chosen by an error or by a frame time from what a study measured, by
// the same rules as --error and --budget, and one line that says what came of it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace weft {

enum class WishKind { by_hand, error, budget };

/// What the sliders ask for.
struct SettingWish {
  WishKind kind = WishKind::by_hand;
  double error_m = 1e-3;
  double budget_ms = 8.0;  ///< a frame
  bool operator==(const SettingWish&) const = default;
};

struct SettingChoice {
  std::optional<study::Point> point;  ///< nothing when no setting does what is asked
  std::string line;
};

/// @param study    of the cloth on this device
/// @param nx       its particles along the width
SettingChoice choose_setting(const study::Study& study, std::uint32_t nx, const SettingWish& wish);

/// The setting that a scene says; automatic substeps are those that run.
study::Setting setting_of(const Scene& scene, std::uint32_t substeps_running);

/// Writes a setting into the scene's solver section.
void set_setting(const study::Setting& setting, Scene& scene);

/// "leapfrog f32, 62 substeps".
std::string setting_text(const study::Setting& setting);

}  // namespace weft
