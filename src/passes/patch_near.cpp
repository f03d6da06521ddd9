// patch_near: which patches may have something near that is not beside them on the cloth, and which of their
// particles something near beside them. Declaration and CPU mirror.
#include <limits>
#include <utility>

#include "passes/folds.h"
#include "passes/lists.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// The search of the patches of one block: most have nothing near but each other and those beside the block,
/// which one search finds out for all four.
template <class T>
class BlockSearch {
 public:
  using V = glm::vec<3, T>;
  BlockSearch(const CollisionView<T>& view, const PatchGrid& patches, const PatchSearch<T>& search,
              std::uint32_t block)
      : view_(view), patches_(patches), search_(search), region_(patches.patches_of(block, 2)) {
    alone_ = !overlooks() && alone(block);
  }

  /// Whether some particle of the patch may have another near that is not beside it.
  bool anything_near(std::uint32_t patch, bool spread) const {
    if (!is_covered(patch)) return false;
    if (!spread || overlooks()) return true;
    bool found = false;
    const auto look_at = [&](std::uint32_t other) {
      found = found || (gap(patch, other) < search_.distance() && !patches_.beside(patch, other));
    };
    if (alone_) {
      patches_.each_of(region_, look_at);
      return found;
    }
    const auto low = search_.low(patch), high = search_.high(patch);
    const bool all = search_.around(low, high, search_.distance(), [&](std::uint32_t other) {
      if (is_near(other, low, high)) patches_.each_of(patches_.patches_of(other), look_at);
      return found;
    });
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

  bool is_near(std::uint32_t block, const V& low, const V& high) const {
    return PatchSearch<T>::gap(low, high, search_.block_low(block), search_.block_high(block)) <
           search_.distance();
  }

  /// Whether no block but those beside it is near the block.
  bool alone(std::uint32_t block) const {
    const V low = search_.block_low(block), high = search_.block_high(block);
    if (!view_.covered({low, T(0)}) || !view_.covered({high, T(0)})) return false;
    bool found = false;
    const bool all = search_.around(low, high, search_.distance(), [&](std::uint32_t other) {
      found = is_near(other, low, high) && !patches_.blocks_beside(block, other);
      return found;
    });
    return all && !found;
  }

  const CollisionView<T>& view_;
  const PatchGrid& patches_;
  const PatchSearch<T>& search_;
  PatchGrid::Block region_;  // with the blocks beside it
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
        const std::uint32_t block = y * blocks.x + x;
        const BlockSearch<T> around(view, patches, search, block);
        patches.each_of(patches.patches_of(block), [&](std::uint32_t p) {
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
