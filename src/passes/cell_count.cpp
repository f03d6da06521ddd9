// cell_count: the box of each patch and where it bends, how many patches each bucket of the grid holds, and
// the longest edge. Declaration and CPU mirror.
#include <atomic>
#include <bit>
#include <utility>

#include "passes/folds.h"
#include "passes/lists.h"
#include "passes/parallel.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft {
namespace {

void raise_to(std::atomic<std::uint32_t>& most, std::uint32_t bits) {
  std::uint32_t before = most;
  while (before < bits && !most.compare_exchange_weak(before, bits)) {
  }
}

template <class T>
std::uint32_t bits_of(T value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

template <class T>
class PatchLook {
 public:
  using V = glm::vec<3, T>;
  PatchLook(const CollisionView<T>& view, const PatchGrid& patches,
            const std::vector<glm::vec<4, T>>& position)
      : view_(view), patches_(patches), position_(position) {}

  /// Writes the patch's box and what is known of its bends.
  void look_at(std::uint32_t patch, glm::vec<4, T>* box) {
    const PatchGrid::Block block = patches_.block(patch);
    V low = at(block.i0, block.j0), high = low;
    for (std::uint32_t j = block.j0; j <= block.j1; ++j)
      for (std::uint32_t i = block.i0; i <= block.i1; ++i) {
        const V x = at(i, j);
        for (int axis = 0; axis < 3; ++axis) {
          low[axis] = std::min(low[axis], x[axis]);
          high[axis] = std::max(high[axis], x[axis]);
        }
        look_at_edges(view_.grid.index(i, j));
      }
    const Folds<T> folds(view_, patches_, position_, patch);
    box[0] = glm::vec<4, T>(low, folds.close() ? T(0) : T(1));
    box[1] = glm::vec<4, T>(high, static_cast<T>(folds.bends()));
  }

  std::uint32_t longest() const { return longest_; }

 private:
  V at(std::uint32_t i, std::uint32_t j) const { return place_in(position_, view_.grid.index(i, j)); }

  void look_at_edges(std::uint32_t p) {
    for (const std::size_t k : {0u, 1u, 2u})  // right, below, below to the left
      if (const auto q = ring_particle(view_.grid, p, k))
        longest_ = std::max(longest_, bits_of(squared_distance(position_[p], position_[*q])));
  }

  const CollisionView<T>& view_;
  const PatchGrid& patches_;
  const std::vector<glm::vec<4, T>>& position_;
  std::uint32_t longest_ = 0;
};

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const PatchGrid patches(context.model.grid);
  const auto& position = std::as_const(buffers)[BufferId::position];
  make_room_for_lists(view.grid, buffers);
  begin_lists(buffers, 0, view.grid.count());
  auto& boxes = buffers[BufferId::patches];
  std::atomic<std::uint32_t> longest = 0;
  parallel_rows(patches.rows(), 2 * std::uint64_t{view.grid.nx}, [&](std::uint32_t begin, std::uint32_t end) {
    PatchLook<T> look(view, patches, position);
    for (std::uint32_t p = begin * patches.nx(); p < end * patches.nx(); ++p)
      look.look_at(p, &boxes[2 * std::size_t{p}]);
    raise_to(longest, look.longest());
  });
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kLongestEdge] = std::max(state[shared::kLongestEdge], longest.load());
  state[shared::kWidestBlock] =
      std::max(state[shared::kWidestBlock], write_blocks(view, patches, buffers, 0, patches.block_count()));
  count_blocks(view, patches, buffers);
}

}  // namespace

const Pass cell_count = [] {
  Pass pass =
      list_pass("cell_count", "self-collision: boxes and folds, and how many each bucket of the grid holds",
                mirror<float>, mirror<double>, shared::kListGroups, patch_domain);
  pass.marches = true;
  return pass;
}();

}  // namespace weft
