// The least of a few turns counts: what disturbs a turn only ever makes it longer.
#include "native/thread_choice.h"

#include <algorithm>
#include <limits>

namespace weft::native {
namespace {

constexpr std::uint64_t kAloneMax = 48 * 48;  // particles; handing rows on costs more than it saves
constexpr double kTurn_s = 2e-4;              // hides what waking the threads costs
constexpr std::uint32_t kTurnSubstepsMax = 64;
constexpr double kTrialEvery_s = 2.0;     // of computing
constexpr double kTrialCostRatio = 20.0;  // at most a twentieth of the time is spent on trials
constexpr double kSettledShare = 0.3;     // of the latest frame in the time that a substep takes
constexpr double kHopeless = 3.0;         // times the fastest: not tried further

}  // namespace

ThreadChoice::ThreadChoice(std::uint32_t threads_max, std::uint64_t particles) {
  if (particles <= kAloneMax) threads_max = 1;
  constexpr std::uint32_t kTryAllBelow = 8;
  for (std::uint32_t count = 1; count < threads_max; count = count < kTryAllBelow ? count + 1 : 2 * count)
    candidates_.push_back(count);
  candidates_.push_back(std::max(1u, threads_max));
  best_ = candidates_.back();
  begin_trial();
}

ThreadChoice ThreadChoice::fixed(std::uint32_t threads) {
  ThreadChoice choice(1, 0);
  choice.candidates_ = {threads};
  choice.best_ = threads;
  return choice;
}

void ThreadChoice::begin_trial() {
  seconds_.assign(candidates_.size(), std::numeric_limits<double>::infinity());
  candidate_ = 0;
  trial_s_ = 0;
  round_ = candidates_.size() > 1 ? 0 : kRounds;
}

Turn ThreadChoice::next(std::uint32_t substeps_left) {
  const double rest_s = std::max(distrusted_ ? 0.0 : kTrialEvery_s, kTrialCostRatio * trial_s_);
  if (!on_trial() && candidates_.size() > 1 && since_trial_s_ >= rest_s) begin_trial();
  if (!on_trial()) return {best_, substeps_left};
  return {candidates_[candidate_], std::min(substeps_left, round_ == 0 ? 2 : turn_substeps_)};
}

void ThreadChoice::report(const Turn& turn, double seconds) {
  const double substep_s = seconds / turn.substeps;
  if (!on_trial()) {
    since_trial_s_ += seconds;
    return report_settled(substep_s);
  }
  if (turn.threads != candidates_[candidate_]) return;
  trial_s_ += seconds;
  seconds_[candidate_] = std::min(seconds_[candidate_], substep_s);
  const double least_s = *std::ranges::min_element(seconds_);
  turn_substeps_ = static_cast<std::uint32_t>(std::clamp(kTurn_s / least_s, 2.0, double{kTurnSubstepsMax}));
  end_turn();
}

/// On to the next candidate that is not hopeless; after the last round the fastest one stays.
void ThreadChoice::end_turn() {
  do {
    if (++candidate_ < candidates_.size()) continue;
    candidate_ = 0;
    if (++round_ < kRounds) continue;
    if (distrusted_) {
      const auto place = std::ranges::find(candidates_, best_) - candidates_.begin();
      seconds_[static_cast<std::size_t>(place)] =
          std::max(seconds_[static_cast<std::size_t>(place)], settled_s_);
    }
    distrusted_ = false;
    settled_s_ = 0;
    const auto least = std::ranges::min_element(seconds_);
    best_ = candidates_[static_cast<std::size_t>(least - seconds_.begin())];
    since_trial_s_ = 0;
    return;
  } while (round_ > 0 && seconds_[candidate_] > kHopeless * *std::ranges::min_element(seconds_));
}

void ThreadChoice::report_settled(double substep_s) {
  settled_s_ = settled_s_ > 0 ? kSettledShare * substep_s + (1 - kSettledShare) * settled_s_ : substep_s;
  distrusted_ = best_ > 1 && settled_s_ > seconds_.front();
}

}  // namespace weft::native
