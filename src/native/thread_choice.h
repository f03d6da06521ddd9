// How many threads sweep a cloth: tried on its own substeps, which have to be computed anyway, since no bit
// depends on it; and tried again now and then, since other programs come and go, and soon when the threads
// have become slower than one alone was: with cores taken by others they wait for each other. In that trial
// turns are long and their mean counts, for short ones may meet free cores by luck.
#pragma once
#include <cstdint>
#include <limits>
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
  struct Candidate {
    std::uint32_t threads = 1;
    double least_s = std::numeric_limits<double>::infinity();  ///< that a substep took in a turn
    double sum_s = 0;                                          ///< of all turns but the first
    std::uint64_t substeps = 0;                                ///< in those
  };
  bool on_trial() const { return round_ < kRounds; }
  void begin_trial();
  std::uint32_t settled_turn() const;
  double substep_s(const Candidate& candidate) const;
  const Candidate& fastest() const;
  void report_settled(double seconds, std::uint32_t substeps);
  void end_turn();

  static constexpr std::uint32_t kRounds = 6;  ///< the first wakes the threads
  std::vector<Candidate> candidates_;          ///< one thread first
  std::uint32_t best_ = 1, round_ = kRounds, candidate_ = 0, turn_substeps_ = 2;
  bool between_ = false;  ///< the latest turn was handed out between two rounds of a trial
  double between_s_ = 0;  ///< computed since the latest round
  double trial_s_ = 0;    ///< what the latest trial took
  double settled_s_ = 0, settled_substeps_ = 0;  ///< computed lately, fading
  bool distrusted_ = false;   ///< best_ was slower than one thread alone, whatever its turns in the trial say
  double since_trial_s_ = 0;  ///< computed since then
};

}  // namespace weft::native
