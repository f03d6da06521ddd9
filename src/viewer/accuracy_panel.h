// The accuracy panel at the window's right edge (F4): the diagram, the two sliders that choose, the live
// estimate, stretch and energy over time, and what all of it costs.
#pragma once
#include <array>
#include <optional>

#include "viewer/accuracy.h"
#include "viewer/panels.h"

namespace weft {

/// What was asked for in it.
struct AccuracyWishes {
  std::optional<study::Setting> setting;                ///< to run now
  std::array<float, 4> error_slider{}, study_button{};  ///< left, top, right, bottom; for tests
  bool start_study = false, cancel_study = false, close = false;
};

/// Width of the panel [screen units at scale 1].
inline constexpr float kAccuracyWidth = 440.0f;

/// Changes nothing but the sliders' own values.
AccuracyWishes draw_accuracy_panel(const RunningScene& running, Accuracy& accuracy);

}  // namespace weft
