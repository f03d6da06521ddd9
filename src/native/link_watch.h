// In which substeps a link may be beyond the strain limit, or long enough to break: in the others nobody has
// to look.
#pragma once
#include <vector>

#include "native/cloth.h"
#include "native/crew.h"
#include "native/leap_watch.h"
#include "plan/plan.h"

namespace weft::native {

/// Whether the sweep can tell: it moves all particles itself, and the scene asks (passes/reach.h asks_links).
bool sweep_watches_links(const Plan& plan, const Model& model);

/// A look at every link says how far the longest is from its limit, which both its ends have to use up; and
/// at every particle how fast they are. While nobody goes farther in a substep than twice that speed takes
/// it, which the sweep tells, so many substeps pass before anybody has to look again.
class LinkWatch final : public LeapWatch {
 public:
  LinkWatch(Cloth& cloth, const Kernels& kernels, const Model& model);

  void tell_sweeps(std::uint32_t, float) override {}  // is_near counts them, or tell_ahead
  void tell_ahead(std::uint32_t substeps) override { left_ -= substeps; }
  void take_back(std::uint32_t) override;
  std::uint32_t quiet_substeps() const override { return leapt_ || one_by_one_ ? 0 : left_; }
  /// Once a substep, after its sweep: whether limit or tearing may have anything to do.
  bool is_near(const Kick& kick, Crew& crew, std::uint32_t threads);
  /// Particles have been moved otherwise.
  void forget();

 private:
  LinkLook look(Crew& crew, std::uint32_t threads);

  Cloth& cloth_;
  const Kernels& kernels_;
  std::vector<float*> rows_;
  float structural_m_, structural_m2_, shear_m_, shear_m2_;  ///< the limits, as the mirrors have them
  std::uint32_t left_ = 0;                                   ///< substeps in which nobody has to look
  bool one_by_one_ = false;                                  ///< somebody leaps before long
};

}  // namespace weft::native
