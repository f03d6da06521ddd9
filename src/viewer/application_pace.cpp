// How often the window draws, and when its next turn begins.
#include <algorithm>
#include <thread>

#include "viewer/application.h"

namespace weft {
namespace {

constexpr double kPart_s = 0.04;               ///< of a frame, that a device computes in one go
constexpr std::chrono::milliseconds kLook{1};  ///< between looks whether a picture is drawn

double since_s(std::chrono::steady_clock::time_point moment) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - moment).count();
}

}  // namespace

/// Drawing takes the simulation's cores where a software device draws. A film keeps its pictures.
void Application::look_at_pictures(double elapsed_s) {
  share_.look(elapsed_s, device_.info().software && !running_.paused() && !film_,
              running_.pacer().slow_motion());
  painter_.set_scale_most(share_.scale_most());
}

/// Whether this turn of the loop draws. What a person does is shown at once, a part of a frame when it is
/// done. None is begun while a software device still draws: it would come no sooner, and the loop would wait
/// instead of looking what the person does.
bool Application::picture_due() const {
  if (!running_.showable()) return false;
  if (view_.screenshot) return true;
  if (device_.info().software && !painter_.idle()) return false;
  if (share_.step() == 0) return true;
  if (since_s(last_event_) < kAwake_s) return since_s(latest_picture_) >= 0.5 * picture_s_;
  // Half a turn early rather than half a turn late.
  const double part_s = running_.on_gpu() != nullptr ? kPart_s : 0.0;
  return since_s(latest_picture_) >= share_.period_s(picture_s_, paint_s_, part_s) - 0.5 * picture_s_;
}

/// The panels see what a person does at once, whenever the next picture comes: two clicks may lie between
/// two.
void Application::turn_panels(bool draws) {
  gui_.begin_frame();
  const PanelWishes wishes = panels_.draw(running_, pending_.value_or(running_.wanted()), facts(), view_);
  show_accuracy();
  if (draw_quit_question(view_)) window_.request_close();
  if (draws) {
    paint();
  } else {
    gui_.skip_frame();
  }
  handle_panels(wishes);
}

/// Displays do not always set the pace (a virtual one never does): wait for the next turn's time.
void Application::pace() {
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(picture_s_));
  const Clock::time_point now = Clock::now();
  next_turn_ = std::max(next_turn_ + period, now);
  if (next_turn_ - now > period) next_turn_ = now + period;
  show_drawn();
  while (!painter_.idle() && Clock::now() + kLook < next_turn_) {
    std::this_thread::sleep_for(kLook);
    show_drawn();
  }
  std::this_thread::sleep_until(next_turn_);
}

void Application::show_drawn() {
  if (const std::optional<double> drawn_s = painter_.show_drawn()) note_paint(*drawn_s);
}

void Application::note_paint(double took_s) { paint_s_ = 0.7 * paint_s_ + 0.3 * took_s; }

}  // namespace weft
