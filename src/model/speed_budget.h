// How fast a cloth can be by what its scene has given it: the bound beyond which a run has diverged.
#pragma once
#include "model/model.h"

namespace weft {

/// Mass of the particles that are free or will be, in units of the interior particle's.
double free_mass_ratio(const Model& model);

/// Whether what a change of a running scene gives the cloth depends on where the cloth is: colliders that may
/// now hold some of it, pins that hold others or elsewhere, another strain limit. Then the budget begins anew
/// with the state.
bool gives_by_place(const Model& before, const Model& next);

/// √(2E/M) of a state, E kinetic, elastic and bending energy, is a norm, and no force of a scene makes it
/// grow faster than a closed form says (docs/physics.md "Divergence"). The mean square speed stays below it.
class SpeedBudget {
 public:
  /// The budget of a state that begins: its own energy.
  /// @param in_double  whether the run computes in double: positions are rounded to 2⁻⁵³, else to 2⁻²⁴
  SpeedBudget(const Model& model, const State& start, bool in_double);

  /// Lets time pass.
  /// @param substeps  that it is cut into, each of which rounds positions once
  /// @param hand_m_s  speed of the fastest particle that something outside the scene moves
  void elapse(const Scene& scene, double duration_s, std::uint32_t substeps, double hand_m_s = 0.0);

  /// Goes on with another model at the same positions and velocities: what stiffer springs store is added.
  /// Not where gives_by_place says that the state has to be known.
  void adopt(const Model& before, const Model& next);

  /// Root of the mean square speed, weighed by mass, that is allowed [m/s]: kMargin times what was given.
  double allowed_m_s() const;

  /// Leapfrog's energy swings in its fastest mode by 1/(1 − 0.9²) = 5.3 times, speed by 2.3; the rest is for
  /// contact and self-contact, which move particles in steps.
  static constexpr double kMargin = 4.0;

 private:
  double given_m_s_;       ///< bound on √(2E/M)
  double reaction_1_s_;    ///< how fast it grows while something moves at 1 m/s
  double farthest_m_ = 0;  ///< that a particle can be from the origin
  double rounding_;        ///< of a position, relative
  double mover_m_s_ = 0;   ///< of the fastest sphere, pin or hand so far
};

/// What a particle's m/m0·v² is multiplied with to count in shares of shared::kWatchWhole; 0 when nothing is
/// free or nothing is allowed yet.
double energy_share_s2_m2(double free_mass_ratio, double allowed_m_s);

}  // namespace weft
