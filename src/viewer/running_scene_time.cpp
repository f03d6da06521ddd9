// How the scene in the window passes its time: frames, parts of frames, and what is told of them.
#include <algorithm>
#include <chrono>
#include <utility>

#include "model/measures.h"
#include "viewer/running_scene.h"

namespace weft {
namespace {

using Seconds = std::chrono::duration<double>;
using Milliseconds = std::chrono::duration<double, std::milli>;

}  // namespace

/// The next frame, or the next short piece of one while a hand moves in it.
void RunningScene::begin_piece() {
  const double frame_s = scene_.solver.frame_s;
  const std::uint32_t substeps = simulation_->plan().substeps;
  if (pieces_left_ == 0) {
    pieces_ = pieces_left_ = hand_.holds() ? hand_.pieces(model().grid, frame_s, substeps) : 1;
    frame_wall_ms_ = frame_computed_ms_ = frame_part_s_ = 0.0;
    pacer_.begin_frame();
    watch_start();
  }
  const double piece_s = frame_s / pieces_;
  if (hand_.holds()) simulation_->place(hand_.move(piece_s));
  simulation_->begin_frame(piece_s, (substeps + pieces_ - 1) / pieces_);
  noted_s_ = simulation_->time_s();
  mid_frame_ = true;
}

void RunningScene::begin_part() {
  if (!mid_frame_) begin_piece();
  more_parts_ = simulation_->continue_frame();
  part_under_way_ = true;
}

/// Waits so long at most for the part under way. Returns whether it has ended.
bool RunningScene::end_part(double wait_s) {
  if (!simulation_->await_part(std::max(wait_s, 0.0))) return false;
  part_under_way_ = false;
  mid_frame_ = more_parts_;
  spent_ms_ += simulation_->part_ms();
  note_part();
  return true;
}

/// What has come of it: progress, the frame's end, what the device found.
void RunningScene::note_part() {
  if (!mid_frame_ && on_host_ != nullptr) frame_computed_ms_ += on_host_->latest_frame_ms();
  const double now_s = simulation_->time_s();
  note_progress(now_s - std::exchange(noted_s_, now_s), simulation_->part_ms());
  if (!mid_frame_) stop_if_diverged();
  if (diverged() || mid_frame_ || --pieces_left_ > 0) return;
  watch_end();
  // The host computes on while a picture is drawn.
  note_frame(on_host_ == nullptr ? frame_wall_ms_ : frame_computed_ms_);
  if (paused_ && steps_due_ > 0) --steps_due_;
  if (!paused_) pacer_.frame_done();
}

/// However long it takes. What is drawn is that moment.
void RunningScene::finish_part() {
  if (!part_under_way_) return;
  simulation_->wait();
  end_part(0.0);
  if (mid_frame_) simulation_->refresh_normals();
}

void RunningScene::note_frame(double took_ms) {
  figures_.frame_ms = figures_.frame_ms > 0.0 ? 0.8 * figures_.frame_ms + 0.2 * took_ms : took_ms;
}

/// A heavy frame takes many pictures: its speed and its cost are told before it is done.
void RunningScene::note_progress(double part_s, double chunk_ms) {
  frame_wall_ms_ += chunk_ms;
  frame_part_s_ += part_s;
  tell_progress();
}

void RunningScene::tell_progress() {
  pacer_.frame_reached(frame_part_s_);
  if (figures_.frame_ms == 0.0 && frame_part_s_ > 0.0)
    figures_.expected_ms = frame_wall_ms_ * scene_.solver.frame_s / frame_part_s_;
}

/// The state before the first part of a frame, if somebody wants to see a frame.
void RunningScene::watch_start() {
  under_watch_.reset();
  if (!watch_wanted_ || pieces_ > 1) return;
  const Clock::time_point start = Clock::now();
  under_watch_.emplace();
  under_watch_->before = simulation_->read();
  under_watch_->frame_s = scene_.solver.frame_s;
  under_watch_->cost_ms = Milliseconds(Clock::now() - start).count();
}

void RunningScene::watch_end() {
  if (!under_watch_) return;
  const Clock::time_point start = Clock::now();
  under_watch_->after = simulation_->read();
  under_watch_->cost_ms += Milliseconds(Clock::now() - start).count();
  watched_ = std::exchange(under_watch_, std::nullopt);
  watch_wanted_ = false;
}

void RunningScene::stop_watching() {
  watch_wanted_ = false;
  under_watch_.reset();
  watched_.reset();
}

void RunningScene::stop_if_diverged() {
  const std::optional<Divergence> found = simulation_->divergence();
  if (!found) return;
  divergence_text_ = fmt::format("{}; likely cause: {}", what_happened(*found, model()),
                                 likely_cause(*found, model(), simulation_->plan()));
  simulation_->write(simulation_->last_good().value_or(start_state(model())));
  release();
  pieces_left_ = 0;
  steps_due_ = 0;
}

void RunningScene::restore() {
  if (!diverged()) return;
  divergence_text_.clear();
  set_paused(true);
}

/// A part that the device has not ended when the time is up goes on meanwhile; the next call takes it in, and
/// begins no other one when it has had its time, so that a picture can be made.
void RunningScene::advance(double wall_s, double budget_s) {
  if (diverged() || (paused_ && steps_due_ == 0)) return;
  if (!paused_) pacer_.elapse(wall_s);
  if (carrying()) return;
  if (may_go_on_by_itself()) return go_on_by_itself(budget_s);
  rest();
  const Clock::time_point start = Clock::now();
  const auto left_s = [&] { return budget_s - Seconds(Clock::now() - start).count(); };
  const auto due = [&] {
    return paused_ ? steps_due_ > 0 : mid_frame_ || pieces_left_ > 0 || pacer_.frame_due();
  };
  bool begins = !part_under_way_;
  if (begins) spent_ms_ = 0.0;
  while (part_under_way_ || (begins && !diverged() && due())) {
    if (!part_under_way_) begin_part();
    if (!end_part(left_s())) return;
    begins = left_s() > 0.0 && spent_ms_ < 1e3 * budget_s;
  }
  pacer_.give_up_rest();
  if (mid_frame_) simulation_->refresh_normals();
}

/// Nobody has to do anything between two frames: no hand moves, nobody asked for a frame's ends.
bool RunningScene::may_go_on_by_itself() const {
  const bool in_pieces = hand_.holds() || pieces_left_ > 1;
  return on_host_ != nullptr && !paused_ && !in_pieces && !watch_wanted_ && !under_watch_;
}

/// The simulation's thread begins what is owed while the window paints. What it could not do in time is owed
/// for a while yet: a short hitch is caught up.
void RunningScene::go_on_by_itself(double budget_s) {
  constexpr double kCatchUp_s = 0.1, kPatience_s = 0.008, kHeavy_ms = 50.0;
  by_itself_ = true;
  const double frame_s = scene_.solver.frame_s;
  take_in(on_host_->go_on(
      {frame_s, simulation_->plan().substeps, frame_s / pacer_.speed(), pacer_.frames_owed()}));
  if (diverged()) return;
  pacer_.give_up_rest(std::max(1.0, kCatchUp_s * pacer_.speed() / frame_s));
  const double patience_s = pacer_.frame_due() ? std::min(budget_s, kPatience_s) : 0.0;
  if (on_host_->show_latest(patience_s) || !mid_frame_) return;
  if (std::max(figures_.frame_ms, figures_.expected_ms) > kHeavy_ms) on_host_->want_middle();
}

void RunningScene::take_in(const FramesDone& done) {
  for (std::uint32_t frame = 0; frame < done.frames; ++frame) {
    pacer_.frame_done();
    note_frame(done.computed_ms / done.frames);
  }
  mid_frame_ = done.under_way;
  pieces_ = 1;
  pieces_left_ = mid_frame_ ? 1 : 0;
  frame_part_s_ = done.part_s;
  frame_wall_ms_ = frame_computed_ms_ = done.part_ms;
  tell_progress();
  if (done.frames > 0) stop_if_diverged();
}

void RunningScene::rest() {
  if (!std::exchange(by_itself_, false)) return;
  take_in(on_host_->stay());
  noted_s_ = simulation_->time_s();
  on_host_->show_latest(0.0);
}

/// What is left of a frame under way is never computed.
void RunningScene::drop_frame() {
  mid_frame_ = part_under_way_ = false;
  pieces_left_ = 0;
  pacer_.begin_frame();
  under_watch_.reset();
}

void RunningScene::set_paused(bool paused) {
  rest();
  finish_part();
  if (paused && mid_frame_) simulation_->refresh_normals();  // what stands is what is shown
  paused_ = paused;
  steps_due_ = 0;
  pacer_.restart();
}

void RunningScene::measure() {
  if (Clock::now() >= next_measure_ && (!mid_frame_ || by_itself_)) measure_now();
}

void RunningScene::measure_now() {
  const Clock::time_point start = Clock::now();
  const State state = simulation_->read();
  figures_.max_stretch = stretch(simulation_->model(), state).maximum;
  figures_.measured_at_s = state.time_s;
  // At most a twentieth of the time goes into looking.
  const Clock::time_point end = Clock::now();
  next_measure_ = end + std::max<Clock::duration>(std::chrono::milliseconds(500), 20 * (end - start));
}

}  // namespace weft
