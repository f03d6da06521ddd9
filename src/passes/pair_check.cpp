// pair_check: does everyone still move in its own room? Do the lists hold, are contacts due? Declaration and
// CPU mirror.
#include <bit>

#include "passes/collision.h"
#include "passes/contact.h"
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
class Leash {
 public:
  using V = glm::vec<3, T>;
  Leash(const CollisionView<T>& view, HostBuffers<T>& buffers)
      : view_(view), buffers_(buffers), state_(buffers.words_of(BufferId::collision_state)) {
    const auto& carrier = buffers[BufferId::carrier];
    shared_v_ = V(carrier[shared::kCarrierVelocity]);
    with_lists_ = V(carrier[shared::kCarrierBuilt]);
    with_contacts_ = V(carrier[shared::kCarrierNear]);
  }

  void look_at(std::uint32_t p) {
    const glm::vec<4, T> at = buffers_[BufferId::position][p];
    V x(at), v(buffers_[BufferId::velocity][p]);
    const V gone = (x - V(buffers_[BufferId::built_position][p])) - with_lists_;
    if (!(dot3(gone, gone) <= view_.moved_squared_max)) stale_ = true;
    if (at.w == T(0)) return;
    const std::uint32_t bits = buffers_.words_of(BufferId::surface_bound)[p];
    const std::uint32_t cuts = state_[shared::kHeldBack];
    hold(x, v, gone, view_.roam_max);
    if (bits != shared::kInfinity) {
      const V since = (x - V(buffers_[BufferId::near_position][p])) - with_contacts_;
      const T near = static_cast<T>(std::bit_cast<float>(bits));
      const T room = near * std::min((T(2) * near) / view_.surface_limit, T(1));
      const T most = static_cast<T>(shared::kRoamShare) * room;
      hold(x, v, since, most);
    }
    if (state_[shared::kHeldBack] == cuts) return;
    buffers_[BufferId::position][p] = glm::vec<4, T>(x, at.w);
    buffers_[BufferId::velocity][p] = glm::vec<4, T>(v, T(0));
  }

  bool stale() const { return stale_; }

 private:
  void hold(V& x, V& v, const V& gone, T most) {
    const T q = dot3(gone, gone);
    if (!(q > most * most)) return;
    const T cut = T(1) - most / std::sqrt(q);
    x = x - cut * gone;
    v = v - cut * (v - shared_v_);
    ++state_[shared::kHeldBack];
  }

  const CollisionView<T>& view_;
  HostBuffers<T>& buffers_;
  std::vector<std::uint32_t>& state_;
  V shared_v_{T(0)}, with_lists_{T(0)}, with_contacts_{T(0)};
  bool stale_ = false;
};

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const CollisionView<T> view(context.model);
  const std::size_t count = context.model.grid.count();
  buffers.words_of(BufferId::cells).assign(view.layout.buckets + 1, 0);
  auto& state = buffers.words_of(BufferId::collision_state);
  const bool first = context.row_index == 0;
  bool stale = first;
  state[shared::kLongestEdge] = state[shared::kWidestBlock] = 0;
  if (first) state[shared::kSmallestGap] = shared::kInfinity;
  if (state[shared::kListsArmed] != 0) {
    buffers[BufferId::near_position].resize(count);
    Leash<T> leash(view, buffers);
    for (std::uint32_t p = 0; p < count; ++p) leash.look_at(p);
    stale |= leash.stale();
  }
  if (state[shared::kPairsListed] != 0) mark_listed(context.model.grid, buffers);
  if (!stale) return;
  const auto groups = [](std::uint32_t items) {
    return (items + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
  };
  state[shared::kListGroups] = groups((view.grid.nx + 1) / 2);
  state[shared::kBlockGroups] = groups((view.grid.nx + 3) / 4);
  state[shared::kNearGroups] = 1;  // at least: patch_near knows how many
  state[shared::kScanGroups] = 1;
}

}  // namespace

const Pass pair_check{
    .name = "pair_check",
    .about = "self-collision: keeps motion in its room; do the lists still hold? empties the grid",
    .domain = collision_domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .marches = true,
    .takes_texels = true,
    .interval = contact_interval,
};

}  // namespace weft
