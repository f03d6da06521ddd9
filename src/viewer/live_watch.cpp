// Looking follows its own cost: whatever takes long is done less often.
#include "viewer/live_watch.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "model/measures.h"
#include "viewer/setting_choice.h"

namespace weft {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr double kSampleEvery_ms = 200.0, kErrorEvery_ms = 3000.0;
constexpr double kShareOfTime = 20.0;  // looking takes at most one part in this
constexpr double kMemory_s = 6.0;      // of the tally of costs

std::chrono::steady_clock::duration milliseconds(double ms) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(Milliseconds(ms));
}

}  // namespace

void LiveWatch::follow(RunningScene& running) {
  renew(running);
  measure_pace(running);
  const Clock::time_point start = Clock::now();
  if (copy_ && copy_->under_way()) go_on();
  take(running);
  const Clock::time_point now = Clock::now();
  spent_ms_ += Milliseconds(now - start).count();
  const double passed_s = 1e-3 * Milliseconds(now - std::exchange(tally_, now)).count();
  cost_ms_per_s_ =
      cost_ms_per_s_ * std::exp(-passed_s / kMemory_s) + std::exchange(spent_ms_, 0.0) / kMemory_s;
}

/// A change of cloth or setting makes what was seen another cloth's.
void LiveWatch::renew(const RunningScene& running) {
  const study::Setting setting = setting_of(running.scene(), running.simulation().plan().substeps);
  const bool other_cloth = running.shown_version() != shown_version_;
  if (!other_cloth && running.version() == version_ && setting == setting_) return;
  shown_version_ = running.shown_version();
  version_ = running.version();
  setting_ = setting;
  copy_.reset();
  error_.reset();
  trouble_.clear();
  device_ms_per_s_ = 0.0;
  next_error_ = Clock::now() + milliseconds(0.2 * kErrorEvery_ms);  // a slider that moves makes no copies
}

/// The time of the running setting, as the device counts it, without what the panel does.
void LiveWatch::measure_pace(const RunningScene& running) {
  const bool unfinished = running.on_gpu() != nullptr && running.mid_frame();
  if (running.hand().holds() || unfinished || running.simulation().time_s() == taken_s_) return;
  taken_s_ = running.simulation().time_s();
  const std::vector<double> steps = running.simulation().step_ms();
  const double ms = std::accumulate(steps.begin(), steps.end(), 0.0) / running.scene().solver.frame_s;
  if (ms > 0.0) device_ms_per_s_ = device_ms_per_s_ > 0.0 ? 0.9 * device_ms_per_s_ + 0.1 * ms : ms;
}

void LiveWatch::take(RunningScene& running) {
  const Clock::time_point start = Clock::now();
  if (start >= next_sample_) running.watch_next_frame();
  std::optional<WatchedFrame> frame = running.take_watched();
  if (!frame || !all_finite(frame->after)) return;
  spent_ms_ += frame->cost_ms;  // it was read while the scene advanced
  history_.add(running.model(), frame->after);
  if (start >= next_error_ && !(copy_ && copy_->under_way()) && trouble_.empty()) {
    try {
      if (!copy_) copy_ = std::make_unique<study::LiveError>(running.bench(), running.model(), setting_);
      copy_->begin(frame->before, frame->after, frame->frame_s);
      begun_s_ = frame->after.time_s;
    } catch (const Error& reason) {  // no room beside the cloth
      copy_.reset();
      trouble_ = reason.what();
    }
  }
  const double cost_ms = frame->cost_ms + Milliseconds(Clock::now() - start).count();
  next_sample_ = Clock::now() + milliseconds(std::max(kSampleEvery_ms, kShareOfTime * cost_ms));
}

void LiveWatch::go_on() {
  const std::optional<double> error_m = copy_->go_on();
  if (!error_m) return;
  error_ = FrameError{*error_m, begun_s_, copy_->cost_ms(), setting_.substeps};
  next_error_ = Clock::now() + milliseconds(std::max(kErrorEvery_ms, kShareOfTime * copy_->cost_ms()));
}

}  // namespace weft
