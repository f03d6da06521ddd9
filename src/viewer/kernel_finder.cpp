// When a trial begins, when it is given up, and what it ends in.
#include "viewer/kernel_finder.h"

#include <algorithm>

#include "sim/kernel_memory.h"

namespace weft {
namespace {

/// "strip 4x16: 0.31 ns a particle and substep, direct took 0.52"
std::string summary(const KernelChoice& choice) {
  const auto ns_of = [&](const Kernel& kernel) {
    return std::ranges::find(choice.trial, kernel, &TimedKernel::kernel)->ns;
  };
  const TimedKernel& first = choice.trial.front();
  if (choice.kernel == first.kernel) return {};
  return fmt::format("kernel {}: {:.3g} ns a particle and substep, where {} takes {:.3g}",
                     describe(choice.kernel), ns_of(choice.kernel), describe(first.kernel), first.ns);
}

}  // namespace

std::string KernelFinder::trying() const {
  return search_ && search_->next() ? describe(*search_->next()) : "";
}

void KernelFinder::begin(RunningScene& running) {
  const Plan& plan = running.simulation().plan();
  if (!is_worth_searching(device_, plan, running.on_gpu()->kernel())) return;
  if (!searched_.insert(kernel_memory_key(plan)).second) return;
  search_ =
      std::make_unique<KernelSearch>(device_, running.model(), plan, nullptr, kernel_memory_file(device_));
}

std::string KernelFinder::follow(RunningScene& running, double elapsed_s) {
  if (!tries_ || running.on_gpu() == nullptr || running.kernel() != "auto") return {};
  if (running.version() != version_) {
    version_ = running.version();
    calm_s_ = 0.0;
    search_.reset();
    return {};
  }
  const bool was_calm = calm_s_ >= kCalm_s;
  calm_s_ += elapsed_s;
  if (!search_) {
    if (!was_calm && calm_s_ >= kCalm_s) begin(running);
    return {};
  }
  std::unique_ptr<KernelSearch> search = std::move(search_);  // one that throws is not gone on with
  if (search->go_on()) {
    search_ = std::move(search);
    return {};
  }
  running.set_kernel("auto");  // which now remembers
  return summary(search->choice());
}

}  // namespace weft
