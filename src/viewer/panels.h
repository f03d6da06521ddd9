// What is written over and beside the scene: sliders, numbers, timings, help, messages. Panels change
// nothing themselves: they return what a person asked for.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scene/reader.h"
#include "viewer/effect_costs.h"
#include "viewer/running_scene.h"
#include "viewer/view_state.h"

namespace weft {

/// What was asked for in the panels this frame.
struct PanelWishes {
  std::optional<Scene> scene;  ///< the same scene with other values
  std::optional<std::string> open, material;
  bool edit_ended = false;  ///< the mouse let go of a slider
  bool reset = false, restore = false, toggle_pause = false, step = false;
  std::optional<double> speed;
  std::optional<bool> allow_xpbd;  ///< in place of a solver that is too slow
  std::optional<double> scale;     ///< of the drawn picture; 0: automatic
  std::optional<std::string> present_mode;
  std::optional<std::string> kernel;  ///< "auto" or one of PanelFacts::kernels
  bool measure_effects = false, stop_measuring = false;
  std::array<float, 4> resolution_slider{};  ///< left, top, right, bottom [screen units]; for tests
};

/// What panels show besides the scene.
struct PanelFacts {
  std::string device;
  bool software = false;
  double pictures_per_s = 0.0;
  double draw_ms = 0.0;
  double scale = 1.0;
  bool automatic_scale = false;
  std::string share;  ///< why there are fewer and smaller pictures; empty: there are not
  std::uint32_t samples = 1;
  std::string present_mode;
  std::vector<std::string> present_modes;
  std::vector<std::string> kernels;  ///< that fit the device and the cloth
  std::string trying;                ///< the kernel that a trial times now; empty when none
  std::vector<AssetInfo> scenes, materials;
  bool validating = false;
  std::size_t validation_messages = 0;
  const EffectCosts* costs = nullptr;  ///< milliseconds beside switches
};

class Panels {
 public:
  /// Width of the panel at the window's left edge [screen units]; the scene takes the rest.
  static constexpr float kWidth = 330.0f;

  /// All panels that are open.
  /// @param pending  the scene with edits that are not applied yet, else the running one's
  PanelWishes draw(const RunningScene&, const Scene& pending, const PanelFacts&, ViewState&);

 private:
  void settings(const RunningScene&, const Scene& pending, const PanelFacts&, ViewState&, PanelWishes&);
  void time_controls(const RunningScene&, PanelWishes&);
  void quick_sliders(Scene&, bool& changed, const PanelFacts&, PanelWishes&);
  void trial_controls(const PanelFacts&, PanelWishes&);
  void all_parameters(Scene&, bool& changed, const PanelFacts&, PanelWishes&);
  void picture_controls(const PanelFacts&, ViewState&, PanelWishes&);

  float overlay_height_ = 0.0f;
};

/// Panels that only show.
/// @return height of the numbers [screen units]
float draw_overlay(const RunningScene&, const PanelFacts&, const ViewState&);
void draw_pass_timings(const RunningScene&, const ViewState&);
void draw_help(ViewState&);
void draw_message(ViewState&);
/// Marks where hands and pins made by hand hold the cloth.
void draw_marks(const RunningScene&, const ViewState&);
/// Says that and why the scene has diverged, and offers the last good state; nothing while it is sound.
void draw_divergence(const RunningScene&, const ViewState&, PanelWishes&);
/// Asks whether to quit. Returns true when the answer is yes.
bool draw_quit_question(ViewState&);

}  // namespace weft
