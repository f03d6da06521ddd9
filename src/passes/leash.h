// How far particles may move between two looks at their surroundings, and what asks for lists anew. Operation
// by operation as docs/float-form.md "Motion".
#pragma once
#include <bit>
#include <cmath>

#include "passes/collision.h"
#include "passes/contact.h"

namespace weft {

/// Empties the grid and forgets what the last lists found out.
/// @return whether the lists are to be made whatever moves: it is the frame's first substep
template <class T>
bool begin_check(const MirrorContext& context, const CollisionView<T>& view, HostBuffers<T>& buffers) {
  buffers.words_of(BufferId::cells).assign(view.layout.buckets + 1, 0);
  auto& state = buffers.words_of(BufferId::collision_state);
  const bool first = context.row_index == 0;
  state[shared::kLongestEdge] = state[shared::kWidestBlock] = 0;
  if (first) state[shared::kSmallestGap] = shared::kInfinity;
  return first;
}

/// Says which passes have something to do.
template <class T>
void end_check(const CollisionView<T>& view, bool stale, HostBuffers<T>& buffers) {
  auto& state = buffers.words_of(BufferId::collision_state);
  if (state[shared::kPairsListed] != 0) mark_listed(view.grid, buffers);
  if (!stale) return;
  const auto groups = [](std::uint32_t items) {
    return (items + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
  };
  state[shared::kListGroups] = groups((view.grid.nx + 1) / 2);
  state[shared::kBlockGroups] = groups((view.grid.nx + 3) / 4);
  state[shared::kNearGroups] = 1;  // at least: patch_near knows how many
  state[shared::kScanGroups] = 1;
}

template <class T>
class Leash {
 public:
  using V = glm::vec<3, T>;
  Leash(const CollisionView<T>& view, const HostBuffers<T>& buffers) : view_(view) {
    const auto& carrier = buffers[BufferId::carrier];
    shared_v_ = V(carrier[shared::kCarrierVelocity]);
    with_lists_ = V(carrier[shared::kCarrierBuilt]);
    with_contacts_ = V(carrier[shared::kCarrierNear]);
  }

  const V& with_lists() const { return with_lists_; }        ///< B
  const V& with_contacts() const { return with_contacts_; }  ///< N

  /// Whether a particle is so far from where it was when the lists were made.
  bool is_stale(const V& x, const V& built) const {
    const V gone = (x - built) - with_lists_;
    return !(dot3(gone, gone) <= view_.moved_squared_max);
  }

  /// Keeps a free particle in its room.
  /// @param bound  bits of the distance of its nearest surface when contacts were looked at
  /// @return how often it was held back
  std::uint32_t keep(V& x, V& v, const V& built, const V& near, std::uint32_t bound) const {
    std::uint32_t cuts = hold(x, v, (x - built) - with_lists_, view_.roam_max);
    if (bound == shared::kInfinity) return cuts;
    const T distance = static_cast<T>(std::bit_cast<float>(bound));
    const T room = distance * std::min((T(2) * distance) / view_.surface_limit, T(1));
    cuts += hold(x, v, (x - near) - with_contacts_, static_cast<T>(shared::kRoamShare) * room);
    return cuts;
  }

 private:
  std::uint32_t hold(V& x, V& v, const V& gone, T most) const {
    const T q = dot3(gone, gone);
    if (!(q > most * most)) return 0;
    const T cut = T(1) - most / std::sqrt(q);
    x = x - cut * gone;
    v = v - cut * (v - shared_v_);
    return 1;
  }

  const CollisionView<T>& view_;
  V shared_v_{T(0)}, with_lists_{T(0)}, with_contacts_{T(0)};
};

}  // namespace weft
