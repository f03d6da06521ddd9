// The lists' order is the mirrors': the cells of the grid one by one, in each the blocks as they stand there,
// in each block its patches and their particles. Which thread takes which block changes nothing, because a
// list is one particle's.
#include "native/near_lists.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "passes/surface_search.h"

namespace weft::native {
namespace {

constexpr std::uint32_t kBlocksAtOnce = 8;        // of a thread
constexpr std::uint32_t kLookersPerThread = 128;  // fewer are done before another thread is awake
constexpr int kCellsAcrossOfBlock = 12;           // farther apart its particles look one by one
constexpr std::uint32_t kBoxless = 1;             // the box of the point's patch is no number

}  // namespace

/// What all blocks of a pass share.
struct NearLists::Gathering {
  const std::vector<glm::vec4>& position;
  const std::vector<std::uint32_t>& listed;
  std::uint32_t looker_count;
  Search search;
  float distance, squared;  ///< how far to look [m]; what is nearer is in question [m²]

  Gathering(const CollisionView<float>& view, const HostBuffers<float>& buffers)
      : position(buffers[BufferId::position]),
        listed(buffers.words_of(BufferId::patch_listed)),
        looker_count(buffers.words_of(BufferId::collision_state)[shared::kLookers]),
        search(view, buffers) {}
};

/// Those of a block that the grid covers.
void NearLists::find_lookers(const Gathering& gathering, std::uint32_t block, Scratch& scratch) const {
  scratch.lookers.clear();
  patches_.each_of(patches_.patches_of(block), [&](std::uint32_t patch) {
    const std::uint32_t looks = gathering.listed[patch];
    if (looks == 0) return;
    const PatchGrid::Block own = patches_.block(patch);
    for (std::uint32_t j = own.j0; j <= own.j1; ++j)
      for (std::uint32_t i = own.i0; i <= own.i1; ++i) {
        const std::uint32_t p = view_.grid.index(i, j), in_patch = (j - own.j0) * 2 + (i - own.i0);
        if ((looks & (shared::kLooksFar | shared::kLooksBeside << in_patch)) != 0 &&
            view_.covered(gathering.position[p]))
          scratch.lookers.push_back({p, looks});
      }
  });
}

/// The points that may be near those lookers. Returns false where they are too far apart to look together.
bool NearLists::collect(const Gathering& gathering, std::span<const Looker> lookers, Scratch& scratch) const {
  scratch.members.clear(), scratch.places.clear(), scratch.from.clear(), scratch.points.clear();
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const Looker& looker : lookers) {
    if ((looker.looks & shared::kLooksFar) == 0) continue;
    const glm::vec3 x(gathering.position[looker.particle]);
    for (int axis = 0; axis < 3; ++axis)
      low[axis] = std::min(low[axis], x[axis]), high[axis] = std::max(high[axis], x[axis]);
  }
  if (low.x > high.x) return true;  // none of them looks far
  const Search& search = gathering.search;
  const bool together = lookers.size() > 1;
  const Search::CellRange range = search.cells_around(
      low, high, gathering.distance, together ? kCellsAcrossOfBlock : shared::kCellsAcrossMax);
  if (together && !range.all) return false;
  search.each_member(range, [&](std::uint32_t block, const Search::Cell& cell) {
    if (Search::gap(low, high, search.block_low(block), search.block_high(block)) < gathering.distance &&
        search.cell_of(block) == cell) {
      scratch.members.push_back({block, cell});
      add_block(gathering, block, low, high, scratch);
    }
    return false;
  });
  scratch.found.resize(std::max(scratch.found.size(), scratch.places.size()));
  return true;
}

/// The particles of a block, but of patches that are too far from all lookers.
void NearLists::add_block(const Gathering& gathering, std::uint32_t block, const glm::vec3& low,
                          const glm::vec3& high, Scratch& scratch) const {
  patches_.each_of(patches_.patches_of(block), [&](std::uint32_t patch) {
    const glm::vec3 patch_low = gathering.search.low(patch), patch_high = gathering.search.high(patch);
    if (!(Search::gap(low, high, patch_low, patch_high) < gathering.distance)) return;
    const bool boxed =
        patch_low.x <= patch_high.x && patch_low.y <= patch_high.y && patch_low.z <= patch_high.z;
    const std::uint32_t from =
        static_cast<std::uint32_t>(2 * (scratch.members.size() - 1)) | (boxed ? 0u : kBoxless);
    const PatchGrid::Block own = patches_.block(patch);
    for (std::uint32_t j = own.j0; j <= own.j1; ++j)
      for (std::uint32_t i = own.i0; i <= own.i1; ++i)
        add_point(gathering.position[view_.grid.index(i, j)], j << view_.layout.column_bits | i, from,
                  scratch);
  });
}

void NearLists::add_point(const glm::vec4& x, std::uint32_t place, std::uint32_t from,
                          Scratch& scratch) const {
  const std::size_t n = scratch.places.size();
  if (n % kColumns == 0)  // the rest of the block is near nothing
    scratch.points.resize(scratch.points.size() + 3 * kColumns, std::numeric_limits<float>::infinity());
  float* const to = scratch.points.data() + n / kColumns * (3 * kColumns) + n % kColumns;
  to[0] = x.x, to[kColumns] = x.y, to[2 * kColumns] = x.z;
  scratch.places.push_back(place);
  scratch.from.push_back(from);
}

/// Calls visit(particle, place) for the collected points that p may list, in their order: as PatchSearch's
/// particles_around, and nearer than `squared`. Boxes that hold all that are numbers of their particles need
/// no look once a point is so near: that is less than `distance` by more than rounding takes.
/// @return whether the search saw all cells
template <class Visit>
bool NearLists::each_near(const Gathering& gathering, std::uint32_t p, Scratch& scratch,
                          Visit&& visit) const {
  const Grid& grid = view_.grid;
  const Search& search = gathering.search;
  const glm::vec3 x(gathering.position[p]);
  const Search::CellRange range = search.cells_around(x, x, gathering.distance);
  const std::size_t count = kernels_.find_near({.points = scratch.points.data(),
                                                .count = scratch.points.size() / 3,
                                                .at = {x.x, x.y, x.z},
                                                .squared = gathering.squared,
                                                .found = scratch.found.data()});
  const std::uint32_t column = p % grid.nx, row = p / grid.nx, top = row - grid.own_row(row);
  const std::uint32_t first = std::max(row, top + 1) - 1, last = std::min(row + 1, top + grid.ny - 1);
  const std::uint32_t columns = (1u << view_.layout.column_bits) - 1;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t n = scratch.found[k], place = scratch.places[n], from = scratch.from[n];
    const std::uint32_t i = place & columns, j = place >> view_.layout.column_bits;
    if (j >= first && j <= last && i + 1 >= column && i <= column + 1) continue;
    const Member& member = scratch.members[from / 2];
    const std::uint32_t q = grid.index(i, j);
    if (!range.has(member.cell)) continue;
    if ((from & kBoxless) == 0 || boxes_near(gathering, x, member.block, q)) visit(q, place);
  }
  return range.all;
}

/// Whether the boxes of a particle's block and patch are near, for those that may not hold it.
bool NearLists::boxes_near(const Gathering& gathering, const glm::vec3& x, std::uint32_t block,
                           std::uint32_t particle) const {
  const std::uint32_t patch = patches_.with(particle);
  const Search& search = gathering.search;
  return Search::gap(x, x, search.block_low(block), search.block_high(block)) < gathering.distance &&
         Search::gap(x, x, search.low(patch), search.high(patch)) < gathering.distance;
}

/// Calls act(looker, scratch) for all of a block that look, with what may be near them collected.
template <class Act>
void NearLists::in_block(const Gathering& gathering, std::uint32_t block, Scratch& scratch,
                         const Act& act) const {
  find_lookers(gathering, block, scratch);
  if (scratch.lookers.empty()) return;
  const bool together = collect(gathering, scratch.lookers, scratch);
  for (const Looker& looker : scratch.lookers) {
    if (!together) collect(gathering, {&looker, 1}, scratch);
    act(looker, scratch);
  }
}

template <class Act>
void NearLists::in_each_block(const Gathering& gathering, Crew& crew, std::uint32_t threads, const Act& act) {
  threads = std::min(threads, gathering.looker_count / kLookersPerThread + 1);
  if (scratch_.size() < threads) scratch_.resize(threads);
  std::atomic<std::uint32_t> next = 0;
  crew.run(threads, [&](std::uint32_t own) {
    Scratch& scratch = scratch_[own];
    const std::uint32_t count = patches_.block_count();
    for (std::uint32_t first = 0; (first = next.fetch_add(kBlocksAtOnce, std::memory_order_relaxed)) < count;)
      for (std::uint32_t block = first; block < std::min(first + kBlocksAtOnce, count); ++block)
        in_block(gathering, block, scratch, act);
  });
}

/// What the threads have counted.
void NearLists::finish(HostBuffers<float>& buffers) {
  std::uint32_t listed = 0;
  for (Scratch& scratch : scratch_) {
    listed |= std::exchange(scratch.listed, 0u);
    buffers.words_of(BufferId::collision_state)[shared::kPairsDropped] += std::exchange(scratch.dropped, 0u);
  }
  if (listed != 0) mark_listed(view_.grid, buffers);
}

void NearLists::gather_pairs(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  if (!lists_in_making(buffers)) return;
  const std::size_t count = view_.grid.count();
  auto& places = buffers.words_of(BufferId::pair_places);
  auto& counts = buffers.words_of(BufferId::pair_count);
  places.resize(count * view_.layout.capacity);
  Gathering gathering(view_, std::as_const(buffers));
  gathering.distance = view_.pair_reach;
  gathering.squared = std::ranges::max(view_.limits, {}, &PairLimit<float>::reach_squared).reach_squared;
  in_each_block(gathering, crew, threads, [&](const Looker& looker, Scratch& scratch) {
    if ((looker.looks & shared::kLooksFar) == 0) return;
    const std::uint32_t p = looker.particle;
    std::uint32_t found = 0;
    each_near(gathering, p, scratch, [&](std::uint32_t q, std::uint32_t place) {
      const float squared = squared_distance(gathering.position[p], gathering.position[q]);
      if (!(squared < view_.limit(p, q).reach_squared)) return;
      if (found < view_.layout.capacity) places[std::size_t{found} * count + p] = place;
      ++found;
    });
    counts[p] = std::min(found, view_.layout.capacity);
    scratch.dropped += found - counts[p];
    scratch.listed |= found;
  });
  finish(buffers);
}

void NearLists::gather_surfaces(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  if (!lists_in_making(buffers)) return;
  const std::size_t count = view_.grid.count();
  auto& entries = buffers.words_of(BufferId::surface_pairs);
  auto& counts = buffers.words_of(BufferId::surface_count);
  entries.resize(count * view_.layout.surface_capacity);
  const SurfaceSearch<float> search(view_, patches_, std::as_const(buffers));
  Gathering gathering(view_, std::as_const(buffers));
  gathering.distance = search.search().surface_distance();
  gathering.squared = search.search().surface_squared();
  in_each_block(gathering, crew, threads, [&](const Looker& looker, Scratch& scratch) {
    const std::uint32_t p = looker.particle;
    std::uint32_t found = 0;
    const auto keep = [&](std::uint32_t code, std::uint32_t place) {
      if (found < view_.layout.surface_capacity)
        entries[found * count + p] = code << shared::kSurfaceCodeShift | place;
      ++found;
    };
    const auto around = [&](const auto& look_at) {
      return each_near(gathering, p, scratch, [&](std::uint32_t q, std::uint32_t) { look_at(q); });
    };
    if (!search.run(p, looker.looks, around, keep)) ++scratch.dropped;
    counts[p] = std::min(found, view_.layout.surface_capacity);
    scratch.dropped += found - counts[p];
    scratch.listed |= counts[p];
  });
  auto& state = buffers.words_of(BufferId::collision_state);
  for (const std::uint32_t word :
       {shared::kListGroups, shared::kBlockGroups, shared::kNearGroups, shared::kScanGroups})
    state[word] = 0;
  finish(buffers);
}

std::uint64_t NearLists::bytes() const {
  std::uint64_t bytes = 0;
  for (const Scratch& scratch : scratch_)
    bytes += scratch.lookers.size() * sizeof(Looker) + scratch.members.size() * sizeof(Member) +
             scratch.points.size() * sizeof(float) +
             (scratch.places.size() + scratch.from.size() + scratch.found.size()) * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace weft::native
