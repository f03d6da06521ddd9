// Between two rounds helpers spin shortly, then sleep, and only those that have work are woken: an idle cloth
// takes no core.
#include "native/crew.h"

namespace weft::native {

Crew::Crew(std::uint32_t helpers) : calls_(helpers + 1) {
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
  wait_for(finished_, count - 1);
}

void Crew::call(std::uint32_t own) {
  calls_[own].round.fetch_add(1, std::memory_order_release);
  calls_[own].round.notify_one();
}

void Crew::help(std::uint32_t own) {
  for (std::uint32_t seen = 0;; ++seen) {
    wait_for(calls_[own].round, seen + 1);
    if (stopping_) return;
    (*task_)(own);
    finished_.fetch_add(1, std::memory_order_release);
    finished_.notify_all();
  }
}

}  // namespace weft::native
