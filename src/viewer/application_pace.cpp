// How often the window draws, and when its next turn begins.
#include <algorithm>
#include <thread>

#include "viewer/application.h"

namespace weft {
namespace {

double since_s(std::chrono::steady_clock::time_point moment) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - moment).count();
}

}  // namespace

/// Drawing takes the simulation's cores where a software device draws what the host computes. A film keeps
/// its pictures.
void Application::look_at_pictures(double elapsed_s) {
  const bool shares_cores = device_.info().software && running_.on_gpu() == nullptr;
  share_.look(elapsed_s, shares_cores && !running_.paused() && !film_, running_.pacer().slow_motion());
  painter_.set_scale_most(share_.scale_most());
}

/// Whether this turn of the loop draws. What a person does is shown at once. Where pictures are fewer, none
/// is begun while the device still draws: it would come no sooner, and the loop would wait instead of looking
/// what the person does.
bool Application::picture_due() const {
  if (share_.step() == 0 || view_.screenshot) return true;
  if (since_s(last_event_) < kAwake_s) return since_s(latest_picture_) >= 0.5 * picture_s_;
  if (!painter_.idle()) return false;
  // Half a turn early rather than half a turn late.
  return since_s(latest_picture_) >= share_.period_s(picture_s_, paint_s_) - 0.5 * picture_s_;
}

/// Displays do not always set the pace (a virtual one never does): wait for the next turn's time.
void Application::pace() {
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(picture_s_));
  const Clock::time_point now = Clock::now();
  next_turn_ = std::max(next_turn_ + period, now);
  if (next_turn_ - now > period) next_turn_ = now + period;
  std::this_thread::sleep_until(next_turn_);
}

}  // namespace weft
