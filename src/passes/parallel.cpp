// A small pool of threads that lives as long as the program: starting threads for every substep would cost
// more than a substep of a small cloth.
#include "passes/parallel.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "core/cores.h"

namespace weft {
namespace {

constexpr std::uint64_t kItemsPerBandMin = 2048;  // below this a wake-up costs more than it saves
constexpr std::uint32_t kRowsPerBandMin = 8;      // each band repeats the springs of the two rows above it

class Pool final : public RowThreads {
 public:
  explicit Pool(unsigned helper_count) {
    for (unsigned t = 0; t < helper_count; ++t) threads_.emplace_back([this] { help(); });
  }
  ~Pool() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    work_ready_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  unsigned size() const override { return static_cast<unsigned>(threads_.size()) + 1; }

  std::uint64_t items_per_band_min() const override { return kItemsPerBandMin; }

  /// One caller at a time, a second one works alone.
  void run(unsigned count, const std::function<void(unsigned)>& task) override {
    const std::unique_lock only(callers_, std::try_to_lock);
    if (!only.owns_lock()) {
      for (unsigned t = 0; t < count; ++t) task(t);
      return;
    }
    std::unique_lock lock(mutex_);
    task_ = &task;
    next_ = 0;
    count_ = count;
    unfinished_ = count;
    work_ready_.notify_all();
    take_tasks(lock);
    all_done_.wait(lock, [this] { return unfinished_ == 0; });
    task_ = nullptr;
  }

 private:
  void help() {
    std::unique_lock lock(mutex_);
    while (true) {
      work_ready_.wait(lock, [this] { return stopping_ || (task_ != nullptr && next_ < count_); });
      if (stopping_) return;
      take_tasks(lock);
    }
  }

  void take_tasks(std::unique_lock<std::mutex>& lock) {
    while (next_ < count_) {
      const unsigned own = next_++;
      const std::function<void(unsigned)>& task = *task_;
      lock.unlock();
      task(own);
      lock.lock();
      if (--unfinished_ == 0) all_done_.notify_all();
    }
  }

  std::mutex callers_, mutex_;
  std::condition_variable work_ready_, all_done_;
  const std::function<void(unsigned)>* task_ = nullptr;
  unsigned next_ = 0, count_ = 0, unfinished_ = 0;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

RowThreads& pool() {
  static Pool shared(usable_cores() - 1);
  return shared;
}

thread_local RowThreads* in_use = nullptr;

}  // namespace

RowThreadsInUse::RowThreadsInUse(RowThreads& threads) : before_(std::exchange(in_use, &threads)) {}
RowThreadsInUse::~RowThreadsInUse() { in_use = before_; }

void parallel_rows(std::uint32_t rows, std::uint64_t items_per_row,
                   const std::function<void(std::uint32_t, std::uint32_t)>& work) {
  RowThreads& threads = in_use != nullptr ? *in_use : pool();
  const std::uint64_t by_items = rows * items_per_row / threads.items_per_band_min();
  const auto bands_max = static_cast<unsigned>(std::min<std::uint64_t>(by_items, rows / kRowsPerBandMin));
  const unsigned bands = std::min(bands_max, threads.size());
  if (bands < 2) {
    work(0, rows);
    return;
  }
  threads.run(bands, [&](unsigned band) {
    const auto edge = [&](std::uint64_t b) { return static_cast<std::uint32_t>(b * rows / bands); };
    work(edge(band), edge(band + 1));
  });
}

}  // namespace weft
