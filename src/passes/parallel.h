// Splits rows of the grid over threads. Which thread does which band never changes a result: bands write
// disjoint rows and read only what nobody writes.
#pragma once
#include <cstdint>
#include <functional>

namespace weft {

/// Threads that rows may be split over.
class RowThreads {
 public:
  virtual ~RowThreads() = default;
  virtual unsigned size() const = 0;
  /// Below so many items a further thread costs more than it saves.
  virtual std::uint64_t items_per_band_min() const = 0;
  /// Runs task(0) … task(count − 1), count ≤ size(), and returns when all are done.
  virtual void run(unsigned count, const std::function<void(unsigned)>& task) = 0;
};

/// While it lives, parallel_rows in the thread that made it splits over these threads in place of its own.
class RowThreadsInUse {
 public:
  explicit RowThreadsInUse(RowThreads& threads);
  ~RowThreadsInUse();
  RowThreadsInUse(const RowThreadsInUse&) = delete;
  RowThreadsInUse& operator=(const RowThreadsInUse&) = delete;

 private:
  RowThreads* before_;
};

/// Calls work(begin, end) on contiguous bands that cover [0, rows) once each, and returns when all are done.
/// Small grids run in the caller's thread. `work` must not throw and must not call parallel_rows.
/// @param items_per_row  how much a row weighs, in particles
void parallel_rows(std::uint32_t rows, std::uint64_t items_per_row,
                   const std::function<void(std::uint32_t, std::uint32_t)>& work);

}  // namespace weft
