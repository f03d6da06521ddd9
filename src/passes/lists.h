// What the lists of self-collision begin with: where everybody was, the boxes of blocks, and who looks for
// others. What the mirrors and native's vector code share. Operation by operation as docs/float-form.md
// "Patches".
#pragma once
#include <limits>

#include "passes/patches.h"

namespace weft {

template <class T>
void make_room_for_lists(const Grid& grid, HostBuffers<T>& buffers) {
  const PatchGrid patches(grid);
  buffers[BufferId::patches].resize(2 * std::size_t{patches.count()});
  buffers[BufferId::blocks].resize(2 * std::size_t{patches.block_count()});
  buffers[BufferId::built_position].resize(grid.count());
  for (const BufferId id : {BufferId::pair_count, BufferId::surface_count, BufferId::surface_bound})
    buffers.words_of(id).resize(grid.count());
}

/// Lists without entries of particles [first, last).
inline void clear_lists(HostWords& buffers, std::size_t first, std::size_t last) {
  for (const BufferId id : {BufferId::pair_count, BufferId::surface_count})
    std::fill(&buffers.words_of(id)[first], &buffers.words_of(id)[first] + (last - first), 0u);
  std::uint32_t* const bounds = &buffers.words_of(BufferId::surface_bound)[first];
  std::fill(bounds, bounds + (last - first), shared::kInfinity);
}

/// Of these particles where they are as the lists are made, and lists without entries.
template <class T>
void begin_lists(HostBuffers<T>& buffers, std::size_t first, std::size_t last) {
  const auto& position = buffers[BufferId::position];
  auto& built = buffers[BufferId::built_position];
  for (std::size_t p = first; p < last; ++p) built[p] = glm::vec<4, T>(glm::vec<3, T>(position[p]), T(0));
  clear_lists(buffers, first, last);
}

/// Counts lists that are being made, empty until somebody finds an entry.
inline void count_lists(HostWords& buffers) {
  auto& state = buffers.words_of(BufferId::collision_state);
  ++state[shared::kListsBuilt];
  state[shared::kListsArmed] = 1;
  state[shared::kLookers] = 0;
  state[shared::kPairsListed] = state[shared::kContactGroups] = 0;
}

/// The lists are made: no pass has anything left to do for them.
inline void end_lists(HostWords& buffers) {
  for (const std::uint32_t word :
       {shared::kListGroups, shared::kBlockGroups, shared::kNearGroups, shared::kScanGroups})
    buffers.words_of(BufferId::collision_state)[word] = 0;
}

/// Writes the boxes of blocks [first, last) from those of their patches.
/// @return bits of the widest side [m] in float
template <class T>
std::uint32_t write_blocks(const CollisionView<T>& view, const PatchGrid& patches, HostBuffers<T>& buffers,
                           std::uint32_t first, std::uint32_t last) {
  using V = glm::vec<3, T>;
  const auto& boxes = buffers[BufferId::patches];
  T widest = T(0);
  for (std::uint32_t block = first; block < last; ++block) {
    V low(std::numeric_limits<T>::max()), high(-low);
    patches.each_of(patches.patches_of(block), [&](std::uint32_t patch) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], boxes[2 * std::size_t{patch}][axis]);
        high[axis] = std::max(high[axis], boxes[2 * std::size_t{patch} + 1][axis]);
      }
    });
    buffers[BufferId::blocks][2 * std::size_t{block}] = glm::vec<4, T>(low, T(0));
    buffers[BufferId::blocks][2 * std::size_t{block} + 1] = glm::vec<4, T>(high, T(0));
    const V wide = high - low;
    if (view.covered({low, T(0)}) && view.covered({high, T(0)}))
      widest = std::max(widest, std::max(std::max(wide.x, wide.y), wide.z));
  }
  return std::bit_cast<std::uint32_t>(static_cast<float>(widest));
}

/// Counts the blocks of each bucket of the grid.
template <class T>
void count_blocks(const CollisionView<T>& view, const PatchGrid& patches, HostBuffers<T>& buffers) {
  const PatchSearch<T> search(view, buffers);
  auto& cells = buffers.words_of(BufferId::cells);
  for (std::uint32_t block = 0; block < patches.block_count(); ++block)
    ++cells[view.bucket_of(search.cell_of(block))];
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
        const std::uint32_t in_patch = (j - block.j0) * 2 + (i - block.i0);
        if ((listed[p] & (shared::kLooksFar | shared::kLooksBeside << in_patch)) != 0)
          lookers[count++] = view.place_of(view.grid.index(i, j));
      }
  }
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kLookers] = count;
  const std::uint32_t groups = (count + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
  state[shared::kNearGroups] = std::clamp(groups, 1u, shared::kLookGroupsMax);
}

}  // namespace weft
