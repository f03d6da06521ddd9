// The crew as mirrors know it: threads that rows may be split over.
#pragma once
#include "native/crew.h"
#include "passes/parallel.h"

namespace weft::native {

class CrewRows final : public RowThreads {
 public:
  /// @param threads  so many of the crew, which outlives this
  CrewRows(Crew& crew, std::uint32_t threads) : crew_(&crew), threads_(threads) {}
  unsigned size() const override { return threads_; }
  std::uint64_t items_per_band_min() const override { return 256; }
  void run(unsigned count, const std::function<void(unsigned)>& task) override { crew_->run(count, task); }

 private:
  Crew* crew_;
  std::uint32_t threads_;
};

}  // namespace weft::native
