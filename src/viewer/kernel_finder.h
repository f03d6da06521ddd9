// The window's trial of the kernels: once a device, size and plan, a candidate a picture, while the cloth
// goes on.
#pragma once
#include <memory>
#include <set>
#include <string>

#include "sim/kernel_search.h"
#include "viewer/running_scene.h"

namespace weft {

class KernelFinder {
 public:
  /// @param tries  without it nothing is ever tried: a software device compiles a candidate for seconds
  KernelFinder(gpu::Device& device, bool tries) : device_(device), tries_(tries) {}

  /// Once a picture. Begins when a cloth has run unchanged for `calm_s` with a kernel that nobody chose and
  /// no trial found; then times a candidate. Lets the cloth go on with the fastest and returns what to say
  /// of it; otherwise empty.
  /// @param elapsed_s  wall time since the last picture
  std::string follow(RunningScene&, double elapsed_s);

  /// The candidate that is timed next, in words; empty when none is.
  std::string trying() const;

  static constexpr double kCalm_s = 1.0;  // a slider that is drawn changes the size at every picture

 private:
  void begin(RunningScene&);

  gpu::Device& device_;
  bool tries_;
  std::uint64_t version_ = 0;
  double calm_s_ = 0.0;
  std::set<std::string>
      searched_;  // keys of plans, so that a cache that cannot be written ends no trial anew
  std::unique_ptr<KernelSearch> search_;
};

}  // namespace weft
