// In which substeps a particle may have left the room that self-collision's lists give it: in the others
// nobody has to look, as long as nothing is listed.
#pragma once
#include "native/leap_watch.h"
#include "plan/plan.h"

namespace weft::native {

/// Whether in a plan with self-collision nothing but the sweep and contacts move particles.
bool sweep_alone_moves(const Plan& plan);

/// Whether the sweep can tell: it alone moves particles, and lists count motion itself, not what is left of
/// it after the motion that all share.
bool sweep_watches_motion(const Plan& plan, const Model& model);

/// A look at everyone says how far from where the lists were made anybody is, and how fast. While nobody goes
/// farther in a substep than that speed and some more takes it, which the sweep tells, the ways of the
/// substeps since add up to less than what is left of the room, and nobody has to look again. How much more
/// follows from how the greatest speed has changed between looks.
class MotionWatch final : public LeapWatch {
 public:
  /// @param room_m  how far anybody may go from where the lists were made
  explicit MotionWatch(double room_m) : room_most_m_(room_m) {}

  void tell_sweeps(std::uint32_t substeps, float drift_s) override;
  void tell_ahead(std::uint32_t) override {}  // tell_sweeps has counted them
  void take_back(std::uint32_t substeps) override;
  std::uint32_t quiet_substeps() const override;
  /// Whether everybody is known to be in the room.
  bool all_are_in() const { return !leapt_ && used_m_ <= room_m_; }
  /// What a look has found: the squares of the longest way from where the lists were made [m²], of the
  /// fastest particle's speed [m²/s²] and of the place farthest from the origin [m²].
  void measured(float gone2, float speed2, float place2);
  /// The lists are made anew where everybody is now.
  void lists_made();
  /// Particles have been moved otherwise, or contacts bound them.
  void forget();

 private:
  double more_at(double speed_m_s) const;

  double room_most_m_, room_m_ = -1.0, used_m_ = 0.0;
  double way_m_ = 0.0;       ///< that anybody goes in a substep, with what rounding adds
  float drift_s_ = 0.0f;     ///< of the latest sweep
  bool one_by_one_ = false;  ///< somebody leaps before long
  double speed_m_s_ = -1.0;  ///< of the fastest when measured last; less than 0: nobody knows
  std::uint32_t swept_ = 0;  ///< substeps since
};

}  // namespace weft::native
