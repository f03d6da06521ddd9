// Threads that wait for work between frames, and the wait they share: spin shortly, then sleep.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace weft::native {

/// How often to look at a flag before sleeping, with the processor's pause between: 10 µs for a neighbour,
/// who is some rows behind, and 50 for the next round of a crew, which follows soon within a frame. With
/// fewer cores than threads, spinning keeps from running whom it waits for: then 200 times at most.
struct Patience {
  int for_neighbour, for_round;
};
Patience patience_of(std::uint32_t threads);

/// Returns when the flag is at least so much: looks so often, then sleeps until it is raised. Beside busy
/// neighbours who sleeps is woken at once, where who only gives its core away waits for its turn.
inline void wait_for(const std::atomic<std::uint32_t>& flag, std::uint32_t least, int looks);

/// Raises a flag that others wait for.
inline void raise(std::atomic<std::uint32_t>& flag, std::uint32_t to) {
  flag.store(to, std::memory_order_release);
  flag.notify_all();
}

/// One thread and its helpers. Not for two callers at a time.
class Crew {
 public:
  explicit Crew(std::uint32_t helpers);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  std::uint32_t size() const { return static_cast<std::uint32_t>(threads_.size()) + 1; }
  /// Runs task(0) in the caller and task(1) … task(count − 1) in helpers, all at the same time; returns when
  /// all are done. `task` must not throw. count is at most size().
  void run(std::uint32_t count, const std::function<void(std::uint32_t)>& task);

 private:
  /// One helper's call: a round it has not seen yet.
  struct alignas(64) Call {
    std::atomic<std::uint32_t> round{0};
  };
  void help(std::uint32_t own);
  void call(std::uint32_t own);

  Patience patience_;
  const std::function<void(std::uint32_t)>* task_ = nullptr;
  bool stopping_ = false;
  std::vector<Call> calls_;                             ///< by task; the first is the caller's and unused
  alignas(64) std::atomic<std::uint32_t> finished_{0};  ///< helpers, in the present round
  std::vector<std::thread> threads_;
};

inline void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

inline void wait_for(const std::atomic<std::uint32_t>& flag, std::uint32_t least, int looks) {
  for (int look = 0; look < looks; ++look) {
    if (flag.load(std::memory_order_acquire) >= least) return;
    pause_briefly();
  }
  for (std::uint32_t now = 0; (now = flag.load(std::memory_order_acquire)) < least;)
    flag.wait(now, std::memory_order_acquire);
}

}  // namespace weft::native
