// What a device gets done of the substeps that a frame needs, said in words; and, where a person allowed it,
// XPBD in place of a solver whose substeps do not fit. Physics never changes silently.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace weft {

/// The last second or so of the window, and the substeps of a frame.
struct Pace {
  double wanted_speed = 1.0;      ///< simulated over wall time, as asked for
  double real_time_factor = 0.0;  ///< the same, as reached; 0: nothing is measured yet
  bool slow = false;              ///< less was reached for long enough to say so
  std::uint32_t needed = 0;       ///< substeps a frame, by the step bound or as set
};

/// The substeps that get done in the wall time that a frame may take; all that are needed where the pace
/// holds.
std::uint32_t substep_budget(const Pace&);

/// A share of real time in two decimals, or in two digits where it is too small for them.
std::string factor_text(double factor);

/// "69 % of the time": what a frame takes of the wall time it may take; empty until one is known.
std::string share_of_time_text(double frame_ms, double allowed_ms);

/// "0.31 x real time: 3600 substeps needed, budget 1116"; empty where the pace holds.
std::string slow_motion_text(const Pace&);

/// Why XPBD cannot run a scene in place of its solver; empty when it can.
std::string why_no_stand_in(const Scene&);

/// XPBD in place of the scene's own solver, while that one's substeps do not fit.
class XpbdStandIn {
 public:
  /// Whether it may take over; the user's word.
  void allow(bool allowed) { allowed_ = allowed; }
  bool allowed() const { return allowed_; }
  bool active() const { return own_.has_value(); }
  /// The solver that the scene asked for, while active.
  const SolverSection& own_solver() const { return own_->solver; }

  /// Looks at the pace. Returns the scene that is to run from now on when it is another.
  /// @param own_needed  substeps the scene's own solver would need now; read while active
  std::optional<Scene> look(const Scene& running, const Pace&, std::uint64_t particles,
                            std::uint32_t own_needed);
  /// Another scene was opened, or the change failed: nothing is taken over.
  void forget() { own_.reset(); }

  /// "xpbd in place of leapfrog: 3600 substeps needed, budget 1116; largest stretch 12.0 %"; empty when not
  /// active.
  std::string text(double max_stretch) const;

 private:
  struct Own {
    SolverSection solver;
    std::uint32_t needed, budget;
    std::uint64_t particles;
  };
  bool allowed_ = false;
  std::optional<Own> own_;
};

}  // namespace weft
