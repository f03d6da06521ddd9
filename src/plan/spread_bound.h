// For how many substeps a cloth that is spread out over a plane, nowhere folded, stays so: nothing of it is
// near anything else of it then, and self-collision has nothing to do. docs/float-form.md "Spread" has the
// proof. What native and the device share of it.
#pragma once
#include <cstdint>

#include "plan/plan.h"

namespace weft {

/// What a look at the cloth has found.
struct SpreadState {
  double margin = -1.0;     ///< cells that edges may change by while it stays spread; less than 0: it is not
  double apart_m_s = 0.0;   ///< largest relative speed of neighbours
  double shared_m_s = 0.0;  ///< a speed that all are taken relative to
  double speed_m_s = 0.0;   ///< then largest speed
  double place_m = 0.0;     ///< of who is the farthest from the origin
};

class SpreadBound {
 public:
  SpreadBound(const Plan& plan, const Model& model);

  /// Whether any cloth can be spread out so well that nothing is in reach.
  bool is_possible() const { return spread_min_ < 1.0; }
  /// What edges have to go along the plane, in cells, to be spread by that margin; and those of cells along
  /// their own.
  double spread_min(double margin) const { return spread_min_ + kPerMargin * margin; }
  double local_min(double margin) const { return local_min_ + kPerMargin * margin; }
  static constexpr double kMargins[] = {0.08, 0.04, 0.02};  ///< in cells, to be tried in this order
  static constexpr double kLongestEdge = 2.0;  ///< cells; the grid has room for what is not longer

  /// Substeps after a look, or before it, in which the cloth stays spread and nobody leaves the room that
  /// lists give: at most `most`.
  /// @param kick_m_s    the largest change of a velocity in any of them
  /// @param late_kicks  kicks between the last drift and the look
  std::uint32_t substeps_within(const SpreadState& at, double drift_s, double kick_m_s, std::uint32_t most,
                                std::uint32_t late_kicks = 0) const;

 private:
  static constexpr double kPerMargin = 1.4142136;  // sqrt 2
  double spacing_m_, spread_min_, local_min_;
  double way_max_m_;  ///< in a substep, with which nobody leaves the lists' room
};

}  // namespace weft
