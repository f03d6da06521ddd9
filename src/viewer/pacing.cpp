// The accumulator and what it tells of speed.
#include "viewer/pacing.h"

#include <algorithm>

namespace weft {
namespace {
constexpr double kHistory_s = 1.0;
}  // namespace

Pacer::Pacer(double frame_s) : frame_s_(frame_s) {}

void Pacer::set_frame(double frame_s) {
  frame_s_ = frame_s;
  restart();
}

void Pacer::set_speed(double speed) {
  speed_ = speed;
  restart();
}

void Pacer::elapse(double wall_s) {
  const double counted_s = std::min(wall_s, kLongest_s);
  debt_s_ += counted_s * speed_;
  wall_s_ += wall_s;
  history_.push_back({wall_s_, simulated_s_});
  while (history_.size() > 2 && wall_s_ - history_[1].wall_s >= kHistory_s) history_.pop_front();
}

void Pacer::frame_done() {
  debt_s_ -= frame_s_;
  frame_reached(frame_s_);
  reached_s_ = 0.0;
}

void Pacer::frame_reached(double simulated_s) {
  simulated_s_ += simulated_s - reached_s_;
  reached_s_ = simulated_s;
}

void Pacer::give_up_rest(double frames) { debt_s_ = std::min(debt_s_, frames * frame_s_); }

void Pacer::restart() {
  debt_s_ = 0.0;
  history_.clear();
}

double Pacer::real_time_factor() const {
  if (history_.empty()) return 0.0;
  const double wall_s = history_.back().wall_s - history_.front().wall_s;
  return wall_s > 0.0 ? (history_.back().simulated_s - history_.front().simulated_s) / wall_s : 0.0;
}

bool Pacer::slow_motion() const {
  if (history_.empty() || history_.back().wall_s - history_.front().wall_s < 0.5 * kHistory_s) return false;
  return real_time_factor() < 0.97 * speed_ - frame_s_ / kHistory_s;
}

}  // namespace weft
