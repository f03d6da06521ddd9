// The lists' order is the mirrors': the cells of the grid one by one, in each the blocks as they stand there,
// in each block its patches and their particles. Which thread takes which block changes nothing, because a
// list is one particle's.
#include "native/near_lists.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "passes/lists.h"
#include "passes/surface_search.h"

namespace weft::native {
namespace {

constexpr std::uint32_t kBlocksAtOnce = 8;        // of a thread
constexpr std::uint32_t kLookersPerThread = 128;  // fewer are done before another thread is awake
constexpr int kCellsAcrossOfBlock = 12;           // farther apart its particles look one by one
constexpr std::uint32_t kBoxless = 1;             // the box of the point's patch is no number

}  // namespace

/// What all blocks share.
struct NearLists::Gathering {
  const std::vector<glm::vec4>& position;
  const std::vector<std::uint32_t>& listed;
  std::uint32_t looker_count;
  SurfaceSearch<float> surface_search;
  const Search& search;
  Reach pairs, surfaces;

  Gathering(const CollisionView<float>& view, const PatchGrid& patches, const HostBuffers<float>& buffers)
      : position(buffers[BufferId::position]),
        listed(buffers.words_of(BufferId::patch_listed)),
        looker_count(buffers.words_of(BufferId::collision_state)[shared::kLookers]),
        surface_search(view, patches, buffers),
        search(surface_search.search()),
        pairs{view.pair_reach,
              std::ranges::max(view.limits, {}, &PairLimit<float>::reach_squared).reach_squared},
        surfaces{search.surface_distance(), search.surface_squared()} {}
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

/// The points that may be near those lookers. Returns whether so many cells along an axis are all.
bool NearLists::collect(const Gathering& gathering, float distance, std::span<const Looker> lookers,
                        int cells_across_max, Scratch& scratch) const {
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
  const Search::CellRange range = search.cells_around(low, high, distance, cells_across_max);
  search.each_member(range, [&](std::uint32_t block, const Search::Cell& cell) {
    if (Search::gap(low, high, search.block_low(block), search.block_high(block)) < distance &&
        search.cell_of(block) == cell) {
      scratch.members.push_back({block, cell});
      add_block(gathering, distance, block, low, high, scratch);
    }
    return false;
  });
  scratch.found.resize(std::max(scratch.found.size(), scratch.places.size()));
  return range.all;
}

/// The particles of a block, but of patches that are too far from all lookers.
void NearLists::add_block(const Gathering& gathering, float distance, std::uint32_t block,
                          const glm::vec3& low, const glm::vec3& high, Scratch& scratch) const {
  patches_.each_of(patches_.patches_of(block), [&](std::uint32_t patch) {
    const glm::vec3 patch_low = gathering.search.low(patch), patch_high = gathering.search.high(patch);
    if (!(Search::gap(low, high, patch_low, patch_high) < distance)) return;
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
/// particles_around, and nearer than the reach's `squared`. Boxes that hold all that are numbers of their
/// particles need no look once a point is so near: that is less than `distance` by more than rounding takes.
/// @return whether the search saw all cells
template <class Visit>
bool NearLists::each_near(const Gathering& gathering, const Reach& reach, std::uint32_t p, Scratch& scratch,
                          Visit&& visit) const {
  const Grid& grid = view_.grid;
  const Search& search = gathering.search;
  const glm::vec3 x(gathering.position[p]);
  const Search::CellRange range = search.cells_around(x, x, reach.distance);
  const std::size_t count = kernels_.find_near({.points = scratch.points.data(),
                                                .count = scratch.points.size() / 3,
                                                .at = {x.x, x.y, x.z},
                                                .squared = reach.squared,
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
    if ((from & kBoxless) == 0 || boxes_near(search, reach.distance, x, member.block, q)) visit(q, place);
  }
  return range.all;
}

/// Whether the boxes of a particle's block and patch are near, for those that may not hold it.
bool NearLists::boxes_near(const Search& search, float distance, const glm::vec3& x, std::uint32_t block,
                           std::uint32_t particle) const {
  const std::uint32_t patch = patches_.with(particle);
  return Search::gap(x, x, search.block_low(block), search.block_high(block)) < distance &&
         Search::gap(x, x, search.low(patch), search.high(patch)) < distance;
}

/// Makes the lists of all of a block that look. Whoever looks alone does so once for each list, in the cells
/// that the mirror's search of it would look into.
void NearLists::gather_in(const Gathering& gathering, std::uint32_t block, Scratch& scratch,
                          HostBuffers<float>& buffers) const {
  find_lookers(gathering, block, scratch);
  if (scratch.lookers.empty()) return;
  const float both = std::max(gathering.pairs.distance, gathering.surfaces.distance);
  const bool together = collect(gathering, both, scratch.lookers, kCellsAcrossOfBlock, scratch);
  const auto look_alone = [&](const Looker& looker, float distance) {
    if (!together) collect(gathering, distance, {&looker, 1}, shared::kCellsAcrossMax, scratch);
  };
  for (const Looker& looker : scratch.lookers) {
    if ((looker.looks & shared::kLooksFar) != 0) {
      look_alone(looker, gathering.pairs.distance);
      list_pairs(gathering, looker.particle, scratch, buffers);
    }
    look_alone(looker, gathering.surfaces.distance);
    list_surfaces(gathering, looker, scratch, buffers);
  }
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

void NearLists::list_pairs(const Gathering& gathering, std::uint32_t p, Scratch& scratch,
                           HostBuffers<float>& buffers) const {
  auto& places = buffers.words_of(BufferId::pair_places);
  std::uint32_t found = 0;
  each_near(gathering, gathering.pairs, p, scratch, [&](std::uint32_t q, std::uint32_t place) {
    const float squared = squared_distance(gathering.position[p], gathering.position[q]);
    if (!(squared < view_.limit(p, q).reach_squared)) return;
    if (found < view_.layout.capacity) places[std::size_t{found} * view_.grid.count() + p] = place;
    ++found;
  });
  const std::uint32_t kept = std::min(found, view_.layout.capacity);
  buffers.words_of(BufferId::pair_count)[p] = kept;
  scratch.dropped += found - kept;
  scratch.listed |= found;
}

void NearLists::list_surfaces(const Gathering& gathering, const Looker& looker, Scratch& scratch,
                              HostBuffers<float>& buffers) const {
  auto& entries = buffers.words_of(BufferId::surface_pairs);
  const std::uint32_t p = looker.particle;
  std::uint32_t found = 0;
  const auto keep = [&](std::uint32_t code, std::uint32_t place) {
    if (found < view_.layout.surface_capacity)
      entries[std::size_t{found} * view_.grid.count() + p] = code << shared::kSurfaceCodeShift | place;
    ++found;
  };
  const auto around = [&](const auto& look_at) {
    return each_near(gathering, gathering.surfaces, p, scratch,
                     [&](std::uint32_t q, std::uint32_t) { look_at(q); });
  };
  if (!gathering.surface_search.run(p, looker.looks, around, keep)) ++scratch.dropped;
  const std::uint32_t kept = std::min(found, view_.layout.surface_capacity);
  buffers.words_of(BufferId::surface_count)[p] = kept;
  scratch.dropped += found - kept;
  scratch.listed |= kept;
}

void NearLists::gather(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  if (!lists_in_making(buffers)) return;
  const std::size_t count = view_.grid.count();
  buffers.words_of(BufferId::pair_places).resize(count * view_.layout.capacity);
  buffers.words_of(BufferId::surface_pairs).resize(count * view_.layout.surface_capacity);
  const Gathering gathering(view_, patches_, std::as_const(buffers));
  threads = std::min(threads, gathering.looker_count / kLookersPerThread + 1);
  if (scratch_.size() < threads) scratch_.resize(threads);
  std::atomic<std::uint32_t> next = 0;
  crew.run(threads, [&](std::uint32_t own) {
    const std::uint32_t blocks = patches_.block_count();
    for (std::uint32_t first = 0;
         (first = next.fetch_add(kBlocksAtOnce, std::memory_order_relaxed)) < blocks;)
      for (std::uint32_t block = first; block < std::min(first + kBlocksAtOnce, blocks); ++block)
        gather_in(gathering, block, scratch_[own], buffers);
  });
  end_lists(buffers);
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
