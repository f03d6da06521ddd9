// Who wants to be told when a sweep takes a particle far: what it then need not look at in every substep.
#pragma once
#include <cstdint>
#include <limits>

namespace weft::native {

/// A look at everyone says how far they may go until something may have to be done, and how fast they are.
/// While nobody leaps, that is goes farther in a substep than that speed and some more takes it, nobody has
/// to look for some substeps. These may be swept at once; if somebody leaps meanwhile they are taken back and
/// swept one by one.
class LeapWatch {
 public:
  virtual ~LeapWatch() = default;
  /// Way in a substep whose square [m²] the sweep has to tell when a particle reaches it.
  float leap2() const { return leap2_; }
  void tell_leap() { leapt_ = true; }
  bool has_leapt() const { return leapt_; }
  /// So many substeps have been swept.
  /// @param drift_s  of each
  virtual void tell_sweeps(std::uint32_t substeps, float drift_s) = 0;
  /// So many of them at once, without a leap: nobody asks in between.
  virtual void tell_ahead(std::uint32_t substeps) = 0;
  /// The latest sweeps, so many substeps, have been taken back.
  virtual void take_back(std::uint32_t substeps) = 0;
  /// Substeps from now on, after whose sweeps nobody has to look unless somebody leaps.
  virtual std::uint32_t quiet_substeps() const = 0;

 protected:
  static constexpr float kNoLeap = std::numeric_limits<float>::infinity();
  float leap2_ = kNoLeap;
  bool leapt_ = false;
};

}  // namespace weft::native
