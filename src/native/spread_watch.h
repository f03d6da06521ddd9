// Frames in which a cloth stays spread out over a plane, nowhere folded: nothing of it is near anything else
// of it, and self-collision has nothing to do but to know that. docs/float-form.md "Spread".
#pragma once
#include <cstdint>

#include "passes/collision.h"
#include "plan/plan.h"

namespace weft::native {

/// Whether sweeps can tell: they alone move particles, and there is one cloth.
bool sweep_watches_spread(const Plan& plan, const Model& model);

/// What a look at the cloth has found.
struct SpreadState {
  double margin = -1.0;     ///< cells that edges may change by while it stays spread; less than 0: it is not
  double apart_m_s = 0.0;   ///< largest relative speed of neighbours
  double shared_m_s = 0.0;  ///< a speed that all are taken relative to
  double speed_m_s = 0.0;   ///< then largest speed
  double place_m = 0.0;     ///< of who is the farthest from the origin
};

/// A look says by how much edges may change, and how fast neighbours part. The sweep tells how much any
/// velocity changes in a substep. From both follows for how many substeps before and after a look the cloth
/// is spread; looks that leave no substep between them prove it for all. A frame in which they do not is
/// taken back to its start and computed otherwise, for what the passes then need from its first substeps on
/// is not there.
class SpreadWatch {
 public:
  SpreadWatch(const Plan& plan, const Model& model);

  /// Whether any cloth can be spread out so well that nothing is in reach.
  bool is_possible() const { return spread_min_ < 1.0; }
  /// What edges have to go along the plane, in cells, to be spread by that margin; and those of cells along
  /// their own.
  double spread_min(double margin) const { return spread_min_ + kPerMargin * margin; }
  double local_min(double margin) const { return local_min_ + kPerMargin * margin; }
  static constexpr double kMargins[] = {0.08, 0.04, 0.02};  ///< in cells, to be tried in this order

  /// Whether to try the frame that begins.
  bool tries_frame();
  /// How many of so many substeps to sweep before the next look; 0: the cloth moves too fast.
  std::uint32_t substeps_from(const SpreadState& begin, double drift_s, std::uint32_t most) const;
  /// Whether the cloth was spread, and nobody left the room that lists give, all the way between two looks.
  /// @param kick2  largest square of a kick [m²/s²]
  bool stayed_spread(const SpreadState& begin, const SpreadState& end, double drift_s, std::uint32_t substeps,
                     float kick2);
  /// The cloth is not spread at a frame's start.
  void pass_frames();
  /// The frame is proven to its end; or has been taken back.
  void end_frame(bool spread);

 private:
  std::uint32_t substeps_within(const SpreadState& at, double drift_s, double kick_m_s,
                                std::uint32_t most) const;

  static constexpr double kPerMargin = 1.4142136;  // sqrt 2: docs/float-form.md
  double spacing_m_, spread_min_, local_min_;
  double way_max_m_;                  ///< in a substep, with which nobody leaves the lists' room
  double kick_m_s_ = -1.0;            ///< of the latest sweeps; less than 0: nobody knows
  double caution_ = 1.5;              ///< how much more a kick may be than the latest
  std::uint32_t frames_to_pass_ = 0;  ///< before the next try
  std::uint32_t frames_passed_ = 1;   ///< after the latest failure
};

}  // namespace weft::native
