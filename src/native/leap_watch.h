// Who wants to be told when a sweep takes a particle far: what it then need not look at in every substep.
#pragma once
#include <cstdint>
#include <limits>

namespace weft::native {

class LeapWatch {
 public:
  virtual ~LeapWatch() = default;
  /// Way in a substep whose square [m²] the sweep has to tell when a particle reaches it.
  float leap2() const { return leap2_; }
  void tell_leap() { leapt_ = true; }
  /// So many substeps have been swept.
  /// @param drift_s  of each
  virtual void tell_sweeps(std::uint32_t substeps, float drift_s) = 0;

 protected:
  static constexpr float kNoLeap = std::numeric_limits<float>::infinity();
  float leap2_ = kNoLeap;
  bool leapt_ = false;
};

}  // namespace weft::native
