// The trial of the kernels, a candidate at a time, so that a window can go on between them.
#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "sim/kernel_choice.h"

namespace weft {

class KernelSearch {
 public:
  /// Times nothing yet. The model is kept, so that a cloth that goes on meanwhile may change.
  /// @param file  where the result is kept; empty: nowhere
  /// @throws Error(Exit::no_device) where buffers beside those of the running cloth do not fit
  KernelSearch(gpu::Device&, const Model&, const Plan&, std::shared_ptr<GpuPipelines>,
               std::filesystem::path file);
  ~KernelSearch();

  /// Times the next candidate on buffers of its own, for some 10 ms and what the driver takes to compile it.
  /// Returns whether more are left; after the last one the fastest is remembered.
  bool go_on();
  /// The next candidate to be timed; null when there is none.
  const Kernel* next() const;
  const KernelChoice& choice() const { return choice_; }  ///< the fastest so far

 private:
  class Trial;

  void settle();

  Model model_;
  Plan plan_;
  std::filesystem::path file_;
  std::vector<Kernel> candidates_;  // that fit
  std::size_t next_ = 0;
  double spent_s_ = 0.0;
  KernelChoice choice_;
  std::unique_ptr<Trial> trial_;
};

}  // namespace weft
