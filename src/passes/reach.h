// Whether the cloth comes near a capsule, a box or a mesh in a substep: what moves the particles says so, and
// where none does, contact has no workgroups.
#pragma once
#include <atomic>

#include "passes/coefficients.h"
#include "passes/host_buffers.h"
#include "shared/reach.h"

namespace weft {

/// What counts as near in one substep. A particle whose drift is shorter than `leap` along each axis and ends
/// outside the box is not touched by any body.
///
/// Why: in the frame of a body at the drift's end, its path begins at Δ·u₀ and ends at u₁, u₀ and u₁ being
/// the particle's places relative to the body's at the drift's start and end, and Δ the body's turn, which
/// moves a point by at most s times its distance. With G = √3·leap + the body's own travel, |Δ·u₀ − u₁| ≤
/// s·|u₀| + G and |u₀| ≤ |u₁| + G. Of a body within E of its place, no path ends farther than R = (E + (1 +
/// s)·G)/(1 − s) that reaches it; so all that do end within s·(R + G) + G of it.
template <class T>
struct ReachRow {
  glm::vec<3, T> low, high;  ///< corners of the box [m]; the first above the second: nothing is near
  T leap;                    ///< [m]
};

/// Whether the scene's plan asks: it has capsules, boxes or meshes, and no floor that leans, which contact
/// with them looks after as well.
bool has_reach(const Model& model);

/// Of a scene that asks. Nothing is near where the row has no drift.
ReachRow<double> reach_row_exact(const Model& model, const KickDrift& row);

template <class T>
ReachRow<T> reach_row(const Model& model, const KickDrift& row) {
  const ReachRow<double> exact = reach_row_exact(model, row);
  return {exact.low, exact.high, static_cast<T>(exact.leap)};
}

/// The words of `reach_groups` before anything moves.
std::vector<std::uint32_t> initial_reach_groups(const Grid& grid);

/// Whether contact has anything to do in this substep; from then on it has not. `word`: kReachSolids or
/// kReachMeshes. Where the buffer is absent nobody asks, and it always may have.
bool take_reach(HostWords& buffers, std::uint32_t word);

/// What the mirrors of the passes that move particles tell.
template <class T>
class ReachTeller {
 public:
  ReachTeller(const MirrorContext& context, HostWords& buffers)
      : words_(buffers.words_of(BufferId::reach_groups)), nx_(context.model.grid.nx) {
    if (!words_.empty()) row_ = reach_row<T>(context.model, context.row);
  }
  ReachTeller(const ReachTeller&) = delete;
  ReachTeller& operator=(const ReachTeller&) = delete;
  ~ReachTeller() {
    if (!reached_) return;
    const std::uint32_t groups = (nx_ + shared::kReachGroup - 1) / shared::kReachGroup;
    for (const std::uint32_t word : {shared::kReachSolids, shared::kReachMeshes})
      words_[word] = std::max(words_[word], groups);
  }

  /// Of a particle that drifted from x0 to x1; any thread may call it.
  void look(const glm::vec<3, T>& x0, const glm::vec<3, T>& x1) {
    if (!words_.empty() && is_near(x0, x1)) reached_.store(true, std::memory_order_relaxed);
  }

 private:
  bool is_near(const glm::vec<3, T>& x0, const glm::vec<3, T>& x1) const {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(x1[axis] - x0[axis]) < row_.leap)) return true;
      inside = inside && x1[axis] > row_.low[axis] && x1[axis] < row_.high[axis];
    }
    return inside;
  }

  std::vector<std::uint32_t>& words_;
  std::uint32_t nx_;
  ReachRow<T> row_{};
  std::atomic<bool> reached_{false};
};

}  // namespace weft
