// patch_near: which patches may have something near that is not beside them on the cloth, and which of their
// particles something near beside them. Declaration and CPU mirror.
#include <limits>
#include <utility>

#include "passes/folds.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// Two by two patches of one cloth, both ends included; and those with the ones beside them.
struct PatchBlock {
  std::uint32_t x0, y0, x1, y1;

  static PatchBlock at(const PatchGrid& patches, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t down = (patches.ny() + 1) / 2, top = y / down * patches.ny();
    const std::uint32_t y0 = top + 2 * (y % down);
    return {2 * x, y0, std::min(2 * x + 1, patches.nx() - 1), std::min(y0 + 1, top + patches.ny() - 1)};
  }
  PatchBlock wider(const PatchGrid& patches) const {
    const std::uint32_t top = y0 / patches.ny() * patches.ny();
    return {std::max(x0, 1u) - 1, std::max(y0, top + 1) - 1, std::min(x1 + 1, patches.nx() - 1),
            std::min(y1 + 1, top + patches.ny() - 1)};
  }
  template <class Visit>
  void each(const PatchGrid& patches, Visit&& visit) const {
    for (std::uint32_t y = y0; y <= y1; ++y)
      for (std::uint32_t x = x0; x <= x1; ++x) visit(y * patches.nx() + x);
  }
  bool has(const PatchGrid& patches, std::uint32_t patch) const {
    const std::uint32_t x = patch % patches.nx(), y = patch / patches.nx();
    return x >= x0 && x <= x1 && y >= y0 && y <= y1;
  }
};

/// The search of the patches of one block: most have nothing near but each other and those beside the block,
/// which one search finds out for all four.
template <class T>
class BlockSearch {
 public:
  using V = glm::vec<3, T>;
  BlockSearch(const CollisionView<T>& view, const PatchGrid& patches, const PatchSearch<T>& search,
              const PatchBlock& block)
      : view_(view), patches_(patches), search_(search), region_(block.wider(patches)) {
    alone_ = !overlooks() && alone(block);
  }

  /// Whether some particle of the patch may have another near that is not beside it.
  bool anything_near(std::uint32_t patch, bool spread) const {
    if (!is_covered(patch)) return false;
    if (!spread || overlooks()) return true;
    bool found = false;
    const auto look_at = [&](std::uint32_t other) {
      found = found || (gap(patch, other) < search_.distance() && !patches_.beside(patch, other));
      return found;
    };
    if (alone_) {
      region_.each(patches_, look_at);
      return found;
    }
    const bool all =
        search_.around(search_.low(patch), search_.high(patch), search_.distance(), false, look_at);
    return found || !all;
  }

 private:
  /// Whether edges are so long that lists may have what is not beside each other and spread out.
  bool overlooks() const { return !(search_.distance() <= view_.patch_search); }
  bool is_covered(std::uint32_t patch) const {
    return view_.covered({search_.low(patch), T(0)}) && view_.covered({search_.high(patch), T(0)});
  }
  T gap(std::uint32_t a, std::uint32_t b) const {
    return PatchSearch<T>::gap(search_.low(a), search_.high(a), search_.low(b), search_.high(b));
  }

  /// Whether no patch but the block's and those beside it is near the box of them all.
  bool alone(const PatchBlock& block) const {
    V low(std::numeric_limits<T>::max()), high(-low);
    bool covered = true;
    block.each(patches_, [&](std::uint32_t p) {
      covered &= is_covered(p);
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], search_.low(p)[axis]);
        high[axis] = std::max(high[axis], search_.high(p)[axis]);
      }
    });
    if (!covered) return false;
    bool found = false;
    const bool all = search_.around(low, high, search_.distance(), false, [&](std::uint32_t other) {
      found = PatchSearch<T>::gap(low, high, search_.low(other), search_.high(other)) < search_.distance() &&
              !region_.has(patches_, other);
      return found;
    });
    return all && !found;
  }

  const CollisionView<T>& view_;
  const PatchGrid& patches_;
  const PatchSearch<T>& search_;
  PatchBlock region_;
  bool alone_;
};

/// The bits of the particles that are at a folded cell; of all of them where a diagonal nearby is creased.
template <class T>
std::uint32_t looks_beside(const CollisionView<T>& view, const PatchGrid& patches,
                           const std::vector<glm::vec<4, T>>& boxes, std::uint32_t patch) {
  std::uint32_t creases = 0;
  patches.each_beside(patch, [&](std::uint32_t other) { creases |= folds_in(boxes, other); });
  if ((creases & shared::kCreased) != 0) return shared::kCreaseBeside | 15u * shared::kLooksBeside;
  const FoldedCells<T> folded(view.grid, patches, boxes);
  const PatchGrid::Block block = patches.block(patch);
  std::uint32_t bits = 0;
  for (std::uint32_t j = block.j0; j <= block.j1; ++j)
    for (std::uint32_t i = block.i0; i <= block.i1; ++i)
      if (folded.any_at(i, j)) bits |= shared::kLooksBeside << ((j - block.j0) * 2 + (i - block.i0));
  return bits;
}

/// Lists the particles that look for others, in the order of the patches.
template <class T>
void tell_lookers(const CollisionView<T>& view, const PatchGrid& patches, HostWords& buffers) {
  const auto& listed = buffers.words_of(BufferId::patch_listed);
  auto& lookers = buffers.words_of(BufferId::lookers);
  lookers.resize(view.grid.count());
  std::uint32_t count = 0;
  for (std::uint32_t p = 0; p < patches.count(); ++p) {
    if (listed[p] == 0) continue;
    const PatchGrid::Block block = patches.block(p);
    for (std::uint32_t j = block.j0; j <= block.j1; ++j)
      for (std::uint32_t i = block.i0; i <= block.i1; ++i) {
        const std::uint32_t looks = shared::kLooksFar | shared::kLooksBeside
                                                            << ((j - block.j0) * 2 + (i - block.i0));
        if ((listed[p] & looks) != 0) lookers[count++] = view.place_of(view.grid.index(i, j));
      }
  }
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kLookers] = count;
  const std::uint32_t groups = (count + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
  state[shared::kNearGroups] = std::clamp(groups, 1u, shared::kLookGroupsMax);
}

/// On the device they come in any order.
void settle_order(HostWords& buffers) {
  if (!lists_in_making(buffers)) return;
  auto& lookers = buffers.words_of(BufferId::lookers);
  const std::size_t count = buffers.words_of(BufferId::collision_state)[shared::kLookers];
  std::sort(lookers.begin(), lookers.begin() + static_cast<std::ptrdiff_t>(std::min(count, lookers.size())));
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const PatchGrid patches(context.model.grid);
  const auto& boxes = std::as_const(buffers)[BufferId::patches];
  auto& listed = buffers.words_of(BufferId::patch_listed);
  listed.resize(patches.count());
  const PatchSearch<T> search(view, buffers);
  const Range blocks = block_domain(context.model);
  parallel_rows(blocks.y, 4 * std::uint64_t{view.grid.nx}, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t y = begin; y < end; ++y)
      for (std::uint32_t x = 0; x < blocks.x; ++x) {
        const PatchBlock block = PatchBlock::at(patches, x, y);
        const BlockSearch<T> around(view, patches, search, block);
        block.each(patches, [&](std::uint32_t p) {
          const bool far = around.anything_near(p, boxes[2 * std::size_t{p}].w != T(0));
          listed[p] = (far ? shared::kLooksFar : 0u) | looks_beside(view, patches, boxes, p);
        });
      }
  });
  tell_lookers(view, patches, buffers);
}

}  // namespace

const Pass patch_near =
    list_pass("patch_near", "self-collision: which particles may have others near, and where", mirror<float>,
              mirror<double>, shared::kBlockGroups, block_domain, settle_order);

}  // namespace weft
