// cell_count: the box of each patch and where it bends, how many patches each bucket of the grid holds, and
// the longest edge. Declaration and CPU mirror.
#include <atomic>
#include <bit>
#include <limits>
#include <utility>

#include "passes/folds.h"
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

  /// Writes the box of a block, whose patches' boxes are known.
  void look_at_block(std::uint32_t block, const std::vector<glm::vec<4, T>>& boxes, glm::vec<4, T>* box) {
    V low(std::numeric_limits<T>::max()), high(-low);
    patches_.each_of(patches_.patches_of(block), [&](std::uint32_t patch) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], boxes[2 * std::size_t{patch}][axis]);
        high[axis] = std::max(high[axis], boxes[2 * std::size_t{patch} + 1][axis]);
      }
    });
    box[0] = glm::vec<4, T>(low, T(0));
    box[1] = glm::vec<4, T>(high, T(0));
    const V wide = high - low;
    if (view_.covered(box[0]) && view_.covered(box[1]))
      widest_ = std::max(widest_, bits_of(std::max(std::max(wide.x, wide.y), wide.z)));
  }

  std::uint32_t longest() const { return longest_; }
  std::uint32_t widest() const { return widest_; }

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
  std::uint32_t longest_ = 0, widest_ = 0;
};

/// Where the particles are as the lists are made, and lists without entries.
template <class T>
void begin_lists(const Grid& grid, HostBuffers<T>& buffers) {
  auto& built = buffers[BufferId::built_position];
  built = std::as_const(buffers)[BufferId::position];
  for (auto& x : built) x.w = T(0);
  for (const BufferId id : {BufferId::pair_count, BufferId::surface_count})
    buffers.words_of(id).assign(grid.count(), 0);
  buffers.words_of(BufferId::surface_bound).assign(grid.count(), shared::kInfinity);
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const PatchGrid patches(context.model.grid);
  begin_lists(context.model.grid, buffers);
  const auto& position = std::as_const(buffers)[BufferId::position];
  auto& boxes = buffers[BufferId::patches];
  auto& blocks = buffers[BufferId::blocks];
  boxes.resize(2 * std::size_t{patches.count()});
  blocks.resize(2 * std::size_t{patches.block_count()});
  std::atomic<std::uint32_t> longest = 0;
  parallel_rows(patches.rows(), 2 * std::uint64_t{view.grid.nx}, [&](std::uint32_t begin, std::uint32_t end) {
    PatchLook<T> look(view, patches, position);
    for (std::uint32_t p = begin * patches.nx(); p < end * patches.nx(); ++p)
      look.look_at(p, &boxes[2 * std::size_t{p}]);
    raise_to(longest, look.longest());
  });
  PatchLook<T> look(view, patches, position);
  for (std::uint32_t b = 0; b < patches.block_count(); ++b)
    look.look_at_block(b, boxes, &blocks[2 * std::size_t{b}]);
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kLongestEdge] = std::max(state[shared::kLongestEdge], longest.load());
  state[shared::kWidestBlock] = std::max(state[shared::kWidestBlock], look.widest());
  const PatchSearch<T> search(view, buffers);
  auto& cells = buffers.words_of(BufferId::cells);
  for (std::uint32_t b = 0; b < patches.block_count(); ++b) ++cells[view.bucket_of(search.cell_of(b))];
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
