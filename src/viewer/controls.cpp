// The meaning of presses, drags and held keys.
#include "viewer/controls.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft {
namespace {

constexpr double kDoubleClick_s = 0.35;
constexpr double kDragBegins = 4.0;        // screen units; less is a click
constexpr double kTurn_rad_unit = 0.006;   // orbit a screen unit
constexpr double kTurn_rad_s = 1.2;        // arrows
constexpr double kMove_distances_s = 0.7;  // WASD, in camera distances
constexpr double kZoomStep = 0.88;
constexpr double kPitchMost_rad = 0.49 * std::numbers::pi;
constexpr double kSpeedStep = 1.25;

void turn(Camera& camera, double yaw_rad, double pitch_rad) {
  camera.yaw_rad += yaw_rad;
  camera.pitch_rad = std::clamp(camera.pitch_rad + pitch_rad, -kPitchMost_rad, kPitchMost_rad);
}

}  // namespace

bool Controls::busy() const {
  if (drag_ != Drag::none) return true;
  for (const KeyRow& row : key_rows())
    if (row.held && window_.held(row.key)) return true;
  return false;
}

ControlWishes Controls::handle(RunningScene& running, ViewState& view, double elapsed_s) {
  ControlWishes wishes;
  for (const InputEvent& event : window_.take_events()) {
    switch (event.kind) {
      case InputEvent::Kind::key: key(event, running, view, wishes); break;
      case InputEvent::Kind::button: button(event, running, view); break;
      case InputEvent::Kind::move: move(event, running, view); break;
      case InputEvent::Kind::scroll:
        if (!gui_.wants_mouse()) view.camera.distance_m *= std::pow(kZoomStep, event.y);
        break;
    }
  }
  if (running.hand().holds()) pull(running, view);
  held_keys(running, view, elapsed_s);
  return wishes;
}

void Controls::key(const InputEvent& event, RunningScene& running, ViewState& view, ControlWishes& wishes) {
  if (view.ask_quit && (event.code == GLFW_KEY_ENTER || event.code == GLFW_KEY_KP_ENTER)) wishes.quit = true;
  if (gui_.wants_keyboard() && event.code != GLFW_KEY_ESCAPE) return;
  const KeyRow* row = find_key(event.code, running.paused());
  if (row == nullptr || row->held) return;
  const bool repeats =
      row->command == Command::step || row->command == Command::slower || row->command == Command::faster;
  if (event.repeated && !repeats) return;
  switch (row->command) {
    case Command::scene: wishes.open_scene = row->argument; break;
    case Command::pause: running.set_paused(!running.paused()); break;
    case Command::step: running.step(); break;
    case Command::reset: running.reset(); break;
    case Command::slower:
    case Command::faster: {
      const double factor = row->command == Command::faster ? kSpeedStep : 1.0 / kSpeedStep;
      const double speed = running.pacer().speed() * factor;
      const bool nearly_one = std::abs(speed - 1.0) < 0.05;  // back to exactly real time
      running.pacer().set_speed(nearly_one ? 1.0 : std::clamp(speed, 0.01, 16.0));
      view.say(fmt::format("speed {:.2f} x", running.pacer().speed()), 1.5);
      break;
    }
    case Command::pin: pin_under_pointer(running, view); break;
    case Command::reload: wishes.reload = true; break;
    case Command::full_screen: wishes.full_screen = true; break;
    case Command::video: wishes.toggle_video = true; break;
    case Command::cancel: cancel(running, view); break;
    default: look_command(row->command, view); break;
  }
}

void Controls::look_command(Command command, ViewState& view) {
  switch (command) {
    case Command::home: view.camera = view.home; break;
    case Command::help: view.help = !view.help; break;
    case Command::overlay: view.overlay = !view.overlay; break;
    case Command::pass_timings: view.timings = !view.timings; break;
    case Command::accuracy: view.accuracy = !view.accuracy; break;
    case Command::panels: view.panels = !view.panels; break;
    case Command::screenshot: view.screenshot = true; break;
    case Command::wireframe: view.look.wireframe = !view.look.wireframe; break;
    case Command::heat_map: view.look.heat = !view.look.heat; break;
    case Command::smooth:
      view.look.shading = view.look.shading == Shading::smooth ? Shading::flat : Shading::smooth;
      break;
    default: break;
  }
}

void Controls::cancel(RunningScene& running, ViewState& view) {
  if (view.ask_quit) {
    view.ask_quit = false;
  } else if (view.message && view.message->is_error) {
    view.message.reset();
  } else if (running.hand().holds()) {
    running.release();
    drag_ = Drag::none;
  } else if (view.help) {
    view.help = false;
  } else {
    view.ask_quit = true;
  }
}

bool Controls::over_scene(const ViewState& view) const {
  const double ratio = static_cast<double>(window_.framebuffer().width) / std::max(1u, window_.size().width);
  const double x = x_ * ratio - view.area.x, y = y_ * ratio - view.area.y;
  return x >= 0.0 && y >= 0.0 && x < view.area.width && y < view.area.height;
}

Ray Controls::ray(const ViewState& view) const {
  const double ratio = static_cast<double>(window_.framebuffer().width) / std::max(1u, window_.size().width);
  return camera_ray(
      view.camera, view.area.aspect(),
      {(x_ * ratio - view.area.x) / view.area.width, (y_ * ratio - view.area.y) / view.area.height});
}

void Controls::button(const InputEvent& event, RunningScene& running, ViewState& view) {
  x_ = event.x;
  y_ = event.y;
  if (!event.pressed) {
    if (drag_ == Drag::cloth || running.hand().holds()) running.release();
    drag_ = Drag::none;
    pressed_on_.reset();
    return;
  }
  if (gui_.wants_mouse() || !over_scene(view)) return;
  if (event.code == GLFW_MOUSE_BUTTON_LEFT) press_left(event, running, view);
  if (event.code == GLFW_MOUSE_BUTTON_MIDDLE) drag_ = Drag::pan;
}

void Controls::press_left(const InputEvent& event, RunningScene& running, ViewState& view) {
  const Clock::time_point now = Clock::now();
  const bool twice = std::chrono::duration<double>(now - press_time_).count() < kDoubleClick_s &&
                     std::hypot(event.x - press_x_, event.y - press_y_) < kDragBegins;
  press_time_ = twice ? Clock::time_point{} : now;
  press_x_ = event.x;
  press_y_ = event.y;
  if (twice) {
    pin_under_pointer(running, view);
    return;
  }
  running.settle();
  pressed_version_ = running.shown_version();
  pressed_on_ = pick_cloth(running.model().grid, running.simulation().read(), ray(view));
  if (!pressed_on_) drag_ = Drag::orbit;
}

void Controls::move(const InputEvent& event, RunningScene& running, ViewState& view) {
  const double dx = event.x - x_, dy = event.y - y_;
  x_ = event.x;
  y_ = event.y;
  if (pressed_on_ && drag_ == Drag::none && std::hypot(x_ - press_x_, y_ - press_y_) >= kDragBegins) {
    running.settle();
    if (pressed_version_ != running.shown_version()) {  // another cloth than the one pressed on
      pressed_on_.reset();
      drag_ = Drag::orbit;
      return;
    }
    const State state = running.simulation().read();
    pressed_on_->point = state.position[pressed_on_->particle];  // it may have moved since the press
    running.grab(state, *pressed_on_);
    drag_ = Drag::cloth;
  }
  if (drag_ == Drag::orbit) turn(view.camera, -kTurn_rad_unit * dx, kTurn_rad_unit * dy);
  if (drag_ == Drag::pan) {
    const double unit_m = 2.0 * view.camera.distance_m * std::tan(0.5 * view.camera.fov_y_rad) /
                          std::max(1u, window_.size().height);
    view.camera.target_m += unit_m * (dy * view.camera.up() - dx * view.camera.right());
  }
}

void Controls::pull(RunningScene& running, const ViewState& view) {
  const auto point = meet_plane(ray(view), running.hand().grip(), view.camera.forward());
  if (point) running.hand().pull_to(*point);
}

void Controls::pin_under_pointer(RunningScene& running, ViewState& view) {
  running.settle();
  const State state = running.simulation().read();
  std::uint32_t particle = 0;
  if (running.hand().holds()) {
    particle = running.hand().center();
  } else {
    const auto pick = pick_cloth(running.model().grid, state, ray(view));
    if (!pick) {
      view.say("no cloth under the pointer to pin", 2.0);
      return;
    }
    particle = pick->particle;
  }
  drag_ = Drag::none;
  pressed_on_.reset();
  const std::size_t before = running.hand_pins().size();
  running.toggle_pin(particle, state.position[particle]);
  view.say(running.hand_pins().size() > before ? "pinned" : "unpinned", 2.0);
}

void Controls::held_keys(const RunningScene& running, ViewState& view, double elapsed_s) {
  if (gui_.wants_keyboard()) return;
  const double angle_rad = kTurn_rad_s * std::min(elapsed_s, 0.1);
  const double way_m = kMove_distances_s * std::min(elapsed_s, 0.1) * view.camera.distance_m;
  for (const KeyRow& row : key_rows()) {
    if (!row.held || !window_.held(row.key) || find_key(row.key, running.paused()) != &row) continue;
    Camera& camera = view.camera;
    switch (row.command) {
      case Command::move_forward: camera.target_m += way_m * camera.forward(); break;
      case Command::move_back: camera.target_m -= way_m * camera.forward(); break;
      case Command::move_left: camera.target_m -= way_m * camera.right(); break;
      case Command::move_right: camera.target_m += way_m * camera.right(); break;
      case Command::turn_left: turn(camera, -angle_rad, 0.0); break;
      case Command::turn_right: turn(camera, angle_rad, 0.0); break;
      case Command::turn_up: turn(camera, 0.0, angle_rad); break;
      case Command::turn_down: turn(camera, 0.0, -angle_rad); break;
      default: break;
    }
  }
}

}  // namespace weft
