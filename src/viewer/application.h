// The window's main loop and everything it owns, in the order in which it is made.
#pragma once
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "gpu/device.h"
#include "viewer/accuracy.h"
#include "viewer/capture.h"
#include "viewer/controls.h"
#include "viewer/effect_costs.h"
#include "viewer/gui.h"
#include "viewer/kernel_finder.h"
#include "viewer/painter.h"
#include "viewer/panels.h"
#include "viewer/picture_share.h"
#include "viewer/running_scene.h"
#include "viewer/state_log.h"
#include "viewer/swapchain.h"
#include "viewer/view_state.h"
#include "viewer/viewer.h"
#include "viewer/window.h"

namespace weft {

class Application {
 public:
  /// @throws Error as run_viewer does
  explicit Application(const ViewerOptions&);
  /// Until the window is closed.
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kAwake_s = 0.5;  ///< after the last event

  void handle_input(double elapsed_s);
  void handle_panels(const PanelWishes&);
  void show_accuracy();
  void turn_panels(bool draws);
  void paint();
  bool picture_due() const;
  void look_at_pictures(double elapsed_s);
  void pace();
  void show_drawn();
  void note_paint(double took_s);
  void find_kernel(double elapsed_s);
  void open(const std::string& which);
  void reload();
  void apply_pending(bool edit_ended);
  void follow_change();
  void toggle_video();
  void save_screenshot(const Picture&);
  void end_film();
  void place_scene();
  PanelFacts facts() const;
  void log();
  std::string accuracy_figures() const;
  bool time_to_quit() const;
  /// Runs what a person asked for; a mistake becomes a message and changes nothing.
  template <class Action>
  void attempt(Action&& action);

  ViewerOptions options_;
  StateLog log_;
  Window window_;
  std::vector<int> threads_before_device_;
  gpu::Device device_;
  int threads_behind_;  ///< of the device's, that draw
  Surface surface_;
  Swapchain swapchain_;
  float ui_scale_;
  RunningScene running_;
  Gui gui_;
  Painter painter_;
  Controls controls_;
  Panels panels_;
  ViewState view_;
  PictureShare share_;
  PanelFacts constant_facts_;
  EffectCosts costs_;
  KernelFinder finder_;
  std::unique_ptr<Accuracy> accuracy_;  // while its panel is open
  std::array<float, 4> resolution_slider_{}, error_slider_{}, study_button_{};
  std::optional<Scene> pending_;
  bool edit_ended_ = false;    ///< that led to it
  bool was_changing_ = false;  ///< a change is begun that is not counted yet
  std::unique_ptr<Film> film_;
  bool scale_was_automatic_ = false;
  Clock::time_point start_ = Clock::now(), latest_ = start_, next_turn_ = start_, film_start_ = start_,
                    last_event_ = start_, latest_picture_ = start_;
  double picture_s_ = 1.0 / 60.0, paint_s_ = 0.0, pictures_per_s_ = 0.0, longest_gap_ms_ = 0.0,
         longest_picture_gap_ms_ = 0.0;
  std::uint64_t pictures_ = 0, rebuilds_ = 0;
};

}  // namespace weft
