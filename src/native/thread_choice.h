// How many threads sweep a cloth: tried on its own substeps, which have to be computed anyway, since no bit
// depends on it; and tried again now and then, since other programs come and go, and soon when the threads
// have become slower than one alone was: with cores taken by others they wait for each other. In that trial
// their latest substeps count instead of the short turns, which may have met free cores by luck.
#pragma once
#include <cstdint>
#include <vector>

namespace weft::native {

/// What to run next: that many substeps in that many threads.
struct Turn {
  std::uint32_t threads, substeps;
};

class ThreadChoice {
 public:
  /// @param threads_max  what the machine and the cloth's rows allow
  /// @param particles    small cloths have one thread without a trial
  ThreadChoice(std::uint32_t threads_max, std::uint64_t particles);
  /// That many threads and no trial.
  static ThreadChoice fixed(std::uint32_t threads);

  Turn next(std::uint32_t substeps_left);
  void report(const Turn& turn, double seconds);
  std::uint32_t best() const { return best_; }

 private:
  bool on_trial() const { return round_ < kRounds; }
  void begin_trial();
  void report_settled(double substep_s);
  void end_turn();

  static constexpr std::uint32_t kRounds = 4;  ///< the first wakes the threads and drops what is far off
  std::vector<std::uint32_t> candidates_;
  std::vector<double> seconds_;  ///< the least a substep took, by candidate
  std::uint32_t best_ = 1, round_ = kRounds, candidate_ = 0, turn_substeps_ = 2;
  double trial_s_ = 0;        ///< what the latest trial took
  double settled_s_ = 0;      ///< what a substep took since then; 0 before the first
  bool distrusted_ = false;   ///< best_ was slower than one thread alone, whatever its turns in the trial say
  double since_trial_s_ = 0;  ///< computed since then
};

}  // namespace weft::native
