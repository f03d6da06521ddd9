// Between two rounds helpers spin shortly, then sleep, and only those that have work are woken: an idle cloth
// takes no core.
#include "native/crew.h"

#include <algorithm>
#include <chrono>

#include "core/cores.h"

namespace weft::native {

namespace {

/// Pauses that take 10 µs: one takes 20 ns on one processor and 50 on another. The least of some short
/// measurements, for what disturbs one only ever makes it longer.
int pauses_in_10_us() {
  using Clock = std::chrono::steady_clock;
  constexpr int kPauses = 100, kTurns = 5;
  double least_s = 1.0;
  for (int turn = 0; turn < kTurns; ++turn) {
    const auto began = Clock::now();
    for (int k = 0; k < kPauses; ++k) pause_briefly();
    least_s = std::min(least_s, std::chrono::duration<double>(Clock::now() - began).count());
  }
  return static_cast<int>(std::clamp(kPauses * 10e-6 / std::max(least_s, 1e-9), 100.0, 2000.0));
}

}  // namespace

Patience patience_of(std::uint32_t threads) {
  static const int pauses = pauses_in_10_us();
  constexpr int kImpatient = 200, kRound = 5;
  const int few = std::min(pauses, kImpatient);
  return threads <= usable_cores() ? Patience{pauses, kRound * pauses} : Patience{few, few};
}

Crew::Crew(std::uint32_t helpers) : patience_(patience_of(helpers + 1)), calls_(helpers + 1) {
  threads_.reserve(helpers);
  for (std::uint32_t own = 1; own <= helpers; ++own) threads_.emplace_back([this, own] { help(own); });
}

Crew::~Crew() {
  stopping_ = true;
  for (std::uint32_t own = 1; own < size(); ++own) call(own);
  for (std::thread& thread : threads_) thread.join();
}

void Crew::run(std::uint32_t count, const std::function<void(std::uint32_t)>& task) {
  task_ = &task;
  finished_.store(0, std::memory_order_relaxed);
  for (std::uint32_t own = 1; own < count; ++own) call(own);
  task(0);
  wait_for(finished_, count - 1, patience_.for_round);
}

void Crew::call(std::uint32_t own) {
  calls_[own].round.fetch_add(1, std::memory_order_release);
  calls_[own].round.notify_one();
}

void Crew::help(std::uint32_t own) {
  for (std::uint32_t seen = 0;; ++seen) {
    wait_for(calls_[own].round, seen + 1, patience_.for_round);
    if (stopping_) return;
    (*task_)(own);
    finished_.fetch_add(1, std::memory_order_release);
    finished_.notify_all();
  }
}

}  // namespace weft::native
