// Keys and mouse: what each press means for the scene and the view.
#pragma once
#include <chrono>
#include <optional>

#include "viewer/gui.h"
#include "viewer/keys.h"
#include "viewer/pick.h"
#include "viewer/running_scene.h"
#include "viewer/view_state.h"
#include "viewer/window.h"

namespace weft {

/// What keys asked for that is not the view's or the scene's own business.
struct ControlWishes {
  int open_scene = 0;  ///< 1 to 6; 0: none
  bool reload = false, toggle_video = false, quit = false, full_screen = false;
};

class Controls {
 public:
  Controls(Window& window, Gui& gui) : window_(window), gui_(gui) {}
  /// Handles what came in since the last call, in order.
  /// @param elapsed_s  wall time since then, for keys that are held
  ControlWishes handle(RunningScene&, ViewState&, double elapsed_s);
  /// Whether a key that moves the camera, or a mouse button, is down.
  bool busy() const;

 private:
  enum class Drag { none, orbit, pan, cloth };
  using Clock = std::chrono::steady_clock;

  void key(const InputEvent&, RunningScene&, ViewState&, ControlWishes&);
  void look_command(Command, ViewState&);
  void cancel(RunningScene&, ViewState&);
  void button(const InputEvent&, RunningScene&, ViewState&);
  void press_left(const InputEvent&, RunningScene&, ViewState&);
  void move(const InputEvent&, RunningScene&, ViewState&);
  void held_keys(const RunningScene&, ViewState&, double elapsed_s);
  void pull(RunningScene&, const ViewState&);
  void pin_under_pointer(RunningScene&, ViewState&);
  Ray ray(const ViewState&) const;
  bool over_scene(const ViewState&) const;

  Window& window_;
  Gui& gui_;
  Drag drag_ = Drag::none;
  std::uint64_t pressed_version_ = 0;  ///< of the cloth that it is part of
  std::optional<Pick> pressed_on_;     ///< the cloth under the last press
  double x_ = 0, y_ = 0, press_x_ = 0, press_y_ = 0;
  Clock::time_point press_time_{};
};

}  // namespace weft
