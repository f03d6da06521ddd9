// Frames in which a cloth stays spread out over a plane, nowhere folded: nothing of it is near anything else
// of it, and self-collision has nothing to do but to know that. docs/float-form.md "Spread".
#pragma once
#include <cstdint>

#include "plan/spread_bound.h"

namespace weft {

/// A look says by how much edges may change, and how fast neighbours part. The sweep tells how much any
/// velocity changes in a substep. From both follows for how many substeps before and after a look the cloth
/// is spread; looks that leave no substep between them prove it for all. A frame in which they do not is
/// taken back to its start and computed otherwise, for what the passes then need from its first substeps on
/// is not there.
class SpreadWatch {
 public:
  SpreadWatch(const Plan& plan, const Model& model);

  const SpreadBound& bound() const { return bound_; }

  /// Whether to try the frame that begins.
  bool tries_frame();
  /// How many of so many substeps to sweep before the next look; 0: the cloth moves too fast.
  std::uint32_t substeps_from(const SpreadState& begin, double drift_s, std::uint32_t most) const;
  /// Whether the cloth was spread, and nobody left the room that lists give, all the way between two looks.
  /// @param kick2  largest square of a velocity's change in a substep [m²/s²]
  bool stayed_spread(const SpreadState& begin, const SpreadState& end, double drift_s, std::uint32_t substeps,
                     float kick2);
  /// The cloth is not spread at a frame's start.
  void pass_frames();
  /// The frame is proven to its end; or has been taken back.
  void end_frame(bool spread);

 private:
  SpreadBound bound_;
  double kick_m_s_ = -1.0;            ///< of the latest sweeps; less than 0: nobody knows
  double caution_ = 1.5;              ///< how much more a kick may be than the latest
  std::uint32_t frames_to_pass_ = 0;  ///< before the next try
  std::uint32_t frames_passed_ = 1;   ///< after the latest failure
};

}  // namespace weft
