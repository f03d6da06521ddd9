// In a trial the least of a few short turns counts, for what disturbs a turn only ever makes it longer; where
// the threads have proved slow it is the mean of longer ones, for then the disturbance is what counts.
#include "native/thread_choice.h"

#include <algorithm>
#include <cmath>

namespace weft::native {
namespace {

constexpr std::uint64_t kAloneMax = 48 * 48;  // particles; handing rows on costs more than it saves
constexpr double kTurn_s = 2e-4;              // hides what waking the threads costs
constexpr double kLongTurn_s = 3e-3;          // as long as a scheduler lets others run
constexpr std::uint32_t kTurnSubstepsMax = 64, kLongTurnSubstepsMax = 1024;
constexpr double kBetweenRounds_s =
    0.012;                                // so that a trial outlasts what comes in bursts, such as a picture
constexpr double kTrialEvery_s = 2.0;     // of computing
constexpr double kTrialCostRatio = 20.0;  // at most a twentieth of the time is spent on trials
constexpr double kSettledTurn_s = 0.01;
constexpr double kSettledMemory_s = 0.3;  // of the time that a substep takes
constexpr double kHopeless = 3.0;         // times the fastest: not tried further

}  // namespace

ThreadChoice::ThreadChoice(std::uint32_t threads_max, std::uint64_t particles) {
  if (particles <= kAloneMax) threads_max = 1;
  constexpr std::uint32_t kTryAllBelow = 8;
  for (std::uint32_t count = 1; count < threads_max; count = count < kTryAllBelow ? count + 1 : 2 * count)
    candidates_.push_back({count});
  candidates_.push_back({std::max(1u, threads_max)});
  best_ = candidates_.back().threads;
  begin_trial();
}

ThreadChoice ThreadChoice::fixed(std::uint32_t threads) {
  ThreadChoice choice(1, 0);
  choice.candidates_ = {{threads}};
  choice.best_ = threads;
  return choice;
}

void ThreadChoice::begin_trial() {
  for (Candidate& candidate : candidates_) candidate = {candidate.threads};
  candidate_ = 0;
  trial_s_ = between_s_ = 0;
  turn_substeps_ = 2;
  round_ = candidates_.size() > 1 ? 0 : kRounds;
}

Turn ThreadChoice::next(std::uint32_t substeps_left) {
  const double rest_s = std::max(distrusted_ ? 0.0 : kTrialEvery_s, kTrialCostRatio * trial_s_);
  if (!on_trial() && candidates_.size() > 1 && since_trial_s_ >= rest_s) begin_trial();
  between_ = on_trial() && round_ > 0 && candidate_ == 0 && between_s_ < kBetweenRounds_s;
  if (between_) return {fastest().threads, std::min(substeps_left, turn_substeps_)};
  if (!on_trial()) return {best_, std::min(substeps_left, settled_turn())};
  return {candidates_[candidate_].threads, std::min(substeps_left, turn_substeps_)};
}

/// Short enough that threads which have become slow are found out within a frame that is long.
std::uint32_t ThreadChoice::settled_turn() const {
  constexpr auto kAll = std::numeric_limits<std::uint32_t>::max();
  if (candidates_.size() == 1 || best_ == 1) return kAll;
  const double substeps = kSettledTurn_s * settled_substeps_ / settled_s_;
  return substeps < 16.0 ? 16 : substeps < double{kAll} ? static_cast<std::uint32_t>(substeps) : kAll;
}

void ThreadChoice::report(const Turn& turn, double seconds) {
  if (between_) {
    between_s_ += seconds;
    return;
  }
  if (!on_trial()) {
    since_trial_s_ += seconds;
    return report_settled(seconds, turn.substeps);
  }
  Candidate& tried = candidates_[candidate_];
  if (turn.threads != tried.threads) return;
  trial_s_ += seconds;
  tried.least_s = std::min(tried.least_s, seconds / turn.substeps);
  if (round_ > 0) {
    tried.sum_s += seconds;
    tried.substeps += turn.substeps;
  }
  end_turn();
}

/// What a substep takes, as far as it is known.
double ThreadChoice::substep_s(const Candidate& candidate) const {
  if (!distrusted_ || candidate.substeps == 0) return candidate.least_s;
  const double mean_s = candidate.sum_s / static_cast<double>(candidate.substeps);
  return candidate.threads == best_ ? std::max(mean_s, settled_s_ / settled_substeps_) : mean_s;
}

const ThreadChoice::Candidate& ThreadChoice::fastest() const {
  return *std::ranges::min_element(candidates_, {}, [&](const Candidate& c) { return substep_s(c); });
}

/// On to the next candidate that is not hopeless; after the last round the fastest one stays.
void ThreadChoice::end_turn() {
  do {
    if (++candidate_ < candidates_.size()) continue;
    candidate_ = 0;
    between_s_ = 0;
    const double turn_s = distrusted_ ? kLongTurn_s : kTurn_s;
    const double most = distrusted_ ? kLongTurnSubstepsMax : kTurnSubstepsMax;
    turn_substeps_ = static_cast<std::uint32_t>(std::clamp(turn_s / fastest().least_s, 2.0, most));
    if (++round_ < kRounds) continue;
    const Candidate& kept = fastest();
    settled_substeps_ = kSettledMemory_s / substep_s(kept);
    settled_s_ = kSettledMemory_s;
    best_ = kept.threads;
    distrusted_ = false;
    since_trial_s_ = 0;
    return;
  } while (round_ > 1 && substep_s(candidates_[candidate_]) > kHopeless * substep_s(fastest()));
}

void ThreadChoice::report_settled(double seconds, std::uint32_t substeps) {
  const double kept = std::exp(-seconds / kSettledMemory_s);
  settled_s_ = kept * settled_s_ + seconds;
  settled_substeps_ = kept * settled_substeps_ + substeps;
  distrusted_ = best_ > 1 && settled_s_ > candidates_.front().least_s * settled_substeps_;
}

}  // namespace weft::native
