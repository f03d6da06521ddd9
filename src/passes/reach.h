// Whether the cloth comes near a capsule, a box or a mesh in a substep, or a link near the strain limit or
// near breaking: what moves the particles says so, and where nothing does, contact, limit and tearing have no
// workgroups.
#pragma once
#include <atomic>
#include <span>

#include "passes/coefficients.h"
#include "passes/host_buffers.h"
#include "passes/parallel.h"
#include "passes/spring_colours.h"
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
///
/// And a link that was no longer than half way to its limit, in a substep in which no particle goes farther
/// than a quarter of that way, ends below it. The limit is where it is pulled back, or where it breaks.
template <class T>
struct ReachRow {
  glm::vec<3, T> low, high;  ///< corners of the box [m]; the first above the second: nothing is near
  T leap;                    ///< [m]
  T link2, diagonal2;        ///< squares of the longest links that are not near the limit [m²]
  T step2;                   ///< square of a drift that may bring them there [m²]
};

/// Whether the cloth is asked about bodies: the scene has capsules, boxes or meshes, and no floor that leans,
/// which contact with them looks after as well.
bool asks_bodies(const Model& model);

/// Whether it is asked about links, if the solver's passes look at them: the scene has a strain limit, or
/// tears, and has shear springs, and nothing moves particles in between that is not asked about: no pins that
/// move, no floor that leans.
bool asks_links(const Model& model);

/// Whether rows have what is asked; tearing tells which pass moves the cloth even where nothing is asked.
inline bool has_reach(const Model& model) {
  return asks_bodies(model) || asks_links(model) || model.scene.tearing;
}

/// Of a scene that asks. Nothing is near where the row has no drift.
ReachRow<double> reach_row_exact(const Model& model, const KickDrift& row);

template <class T>
ReachRow<T> reach_row(const Model& model, const KickDrift& row) {
  const ReachRow<double> exact = reach_row_exact(model, row);
  return {exact.low,
          exact.high,
          static_cast<T>(exact.leap),
          static_cast<T>(exact.link2),
          static_cast<T>(exact.diagonal2),
          static_cast<T>(exact.step2)};
}

/// The words of `reach_groups` before anything moves, of a whole cloth.
/// @param links  whether what moves the particles looks at links
std::vector<std::uint32_t> initial_reach_groups(const Model& model, bool links);

/// Says in the words of a scene with tearing whether any of the cloth's links is broken.
void tell_torn(const Grid& grid, std::span<const std::uint32_t> broken_links,
               std::vector<std::uint32_t>& words);

/// Whether integrate_torn moves the cloth in integrate's place: a link is broken, or nobody tells.
bool is_torn(const Model& model, const HostWords& buffers);

/// Whether contact has anything to do in this substep; from then on it has not. `word`: kReachSolids or
/// kReachMeshes. Where nobody asks it always may have.
bool take_reach(const Model& model, HostWords& buffers, std::uint32_t word);

/// The same of tear.
bool take_tear(HostWords& buffers);

/// Where strain_limit's item finds its workgroups.
constexpr std::uint32_t reach_word_of_colour(std::uint32_t item) {
  return item / 2 == kStructuralJ ? shared::kReachLinksDown : shared::kReachLinks;
}

/// Whether that item has anything to do; after the last of its shape none has.
bool take_links(HostWords& buffers, std::uint32_t item);

/// What the mirrors of the passes that move particles tell.
template <class T>
class ReachTeller {
 public:
  ReachTeller(const MirrorContext& context, HostWords& buffers)
      : words_(buffers.words_of(BufferId::reach_groups)), nx_(context.model.grid.nx) {
    if (words_.empty()) return;
    row_ = reach_row<T>(context.model, context.row);
    asks_links_ = words_[shared::kReachAsksLinks] != 0;
    tears_ = context.model.scene.tearing.has_value();
  }
  ReachTeller(const ReachTeller&) = delete;
  ReachTeller& operator=(const ReachTeller&) = delete;
  ~ReachTeller() {
    if (reached_) tell({shared::kReachSolids, shared::kReachMeshes}, nx_);
    if (asks_links_ && (reached_ || tight_)) tell_of_links();
  }

  /// Of every link, before the particles move.
  void look_at_links(const Grid& grid, const std::vector<glm::vec<4, T>>& position) {
    if (!asks_links_) return;
    const auto look_at = [&](std::uint32_t a, std::uint32_t b, T most) {
      const glm::vec<3, T> d = glm::vec<3, T>(position[b]) - glm::vec<3, T>(position[a]);
      return squared(d) <= most;
    };
    parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
      bool short_enough = true;
      for (std::uint32_t p = begin * grid.nx; p < end * grid.nx && short_enough; ++p) {
        const bool right = p % grid.nx + 1 < grid.nx;
        const bool down = grid.own_row(p / grid.nx) + 1 < grid.ny;
        if (right) short_enough = look_at(p, p + 1, row_.link2);
        if (down) short_enough = short_enough && look_at(p, p + grid.nx, row_.link2);
        if (!right || !down) continue;
        short_enough = short_enough && look_at(p, p + grid.nx + 1, row_.diagonal2) &&
                       look_at(p + 1, p + grid.nx, row_.diagonal2);
      }
      if (!short_enough) tight_.store(true, std::memory_order_relaxed);
    });
  }

  /// Of a torn cloth, whose broken links are long: more may break in every substep.
  void look_at_torn() { tight_ = true; }

  /// Of a particle that drifted from x0 to x1; any thread may call it.
  void look(const glm::vec<3, T>& x0, const glm::vec<3, T>& x1) {
    if (words_.empty()) return;
    if (is_near(x0, x1)) reached_.store(true, std::memory_order_relaxed);
    if (asks_links_ && !(squared(x1 - x0) < row_.step2)) tight_.store(true, std::memory_order_relaxed);
  }

 private:
  static T squared(const glm::vec<3, T>& d) { return (d.x * d.x + d.y * d.y) + d.z * d.z; }
  void tell_of_links() {
    if (tears_) return tell({shared::kReachTear}, nx_);
    tell({shared::kReachLinks}, (nx_ + 1) / 2);
    tell({shared::kReachLinksDown}, nx_);
  }
  /// Workgroups over so many columns, if there were fewer.
  void tell(std::initializer_list<std::uint32_t> words, std::uint32_t columns) {
    for (const std::uint32_t word : words)
      words_[word] = std::max(words_[word], (columns + shared::kReachGroup - 1) / shared::kReachGroup);
  }
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
  bool asks_links_ = false, tears_ = false;
  std::atomic<bool> reached_{false}, tight_{false};
};

}  // namespace weft
