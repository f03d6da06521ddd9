// Patches of 2 x 2 particles of one cloth, and blocks of 2 x 2 patches, which self-collision's grid holds.
// What the mirrors of the passes that make lists share. Operation by operation as docs/float-form.md
// "Patches".
#pragma once
#include <algorithm>
#include <array>
#include <bit>

#include "passes/collision.h"
#include "passes/parallel.h"
#include "passes/surface.h"

namespace weft {

/// Where the patches of a scene are.
class PatchGrid {
 public:
  explicit PatchGrid(const Grid& grid) : grid_(grid), nx_((grid.nx + 1) / 2), ny_((grid.ny + 1) / 2) {}

  std::uint32_t nx() const { return nx_; }
  std::uint32_t ny() const { return ny_; }                                ///< of one cloth
  std::uint32_t rows() const { return ny_ * (grid_.rows() / grid_.ny); }  ///< of all cloths
  std::uint32_t count() const { return nx_ * rows(); }

  /// Columns and rows of particles, both ends included.
  struct Block {
    std::uint32_t i0, j0, i1, j1;
  };
  /// The particles of a patch and as many more on every side as its cloth has of them.
  Block block(std::uint32_t patch, std::uint32_t more = 0) const {
    const std::uint32_t row = patch / nx_, top = row / ny_ * grid_.ny, i = 2 * (patch % nx_),
                        j = top + 2 * (row % ny_);
    return {std::max(i, more) - more, std::max(j, top + more) - more, std::min(i + 1 + more, grid_.nx - 1),
            std::min(j + 1 + more, top + grid_.ny - 1)};
  }

  std::uint32_t blocks_x() const { return (nx_ + 1) / 2; }
  std::uint32_t blocks_y() const { return (ny_ + 1) / 2; }  ///< of one cloth
  std::uint32_t block_count() const { return blocks_x() * blocks_y() * (rows() / ny_); }

  /// Columns and rows of patches, both ends included: those of a block and `more` on every side, as many as
  /// its cloth has of them.
  Block patches_of(std::uint32_t block, std::uint32_t more = 0) const {
    const std::uint32_t row = block / blocks_x(), top = row / blocks_y() * ny_, x = 2 * (block % blocks_x()),
                        y = top + 2 * (row % blocks_y());
    return {std::max(x, more) - more, std::max(y, top + more) - more, std::min(x + 1 + more, nx_ - 1),
            std::min(y + 1 + more, top + ny_ - 1)};
  }
  /// Calls visit(patch) for all of those, row by row.
  template <class Visit>
  void each_of(const Block& patches, Visit&& visit) const {
    for (std::uint32_t y = patches.j0; y <= patches.j1; ++y)
      for (std::uint32_t x = patches.i0; x <= patches.i1; ++x) visit(y * nx_ + x);
  }

  /// Whether two blocks are the same or beside each other on one cloth.
  bool blocks_beside(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t across = blocks_x();
    return close_by(a % across, b % across) && close_by(a / across, b / across) &&
           a / across / blocks_y() == b / across / blocks_y();
  }

  /// Calls visit(particle) for those of the patch, row by row.
  template <class Visit>
  void each_particle(std::uint32_t patch, Visit&& visit) const {
    const Block own = block(patch);
    for (std::uint32_t j = own.j0; j <= own.j1; ++j)
      for (std::uint32_t i = own.i0; i <= own.i1; ++i) visit(grid_.index(i, j));
  }

  std::uint32_t with(std::uint32_t particle) const {
    const std::uint32_t row = particle / grid_.nx, own = grid_.own_row(row);
    return ((row - own) / grid_.ny * ny_ + own / 2) * nx_ + particle % grid_.nx / 2;
  }

  /// Calls visit(patch) for the patch and those beside it on its cloth.
  template <class Visit>
  void each_beside(std::uint32_t patch, Visit&& visit) const {
    const std::uint32_t x = patch % nx_, y = patch / nx_, top = y / ny_ * ny_;
    for (std::uint32_t row = std::max(y, top + 1) - 1; row <= std::min(y + 1, top + ny_ - 1); ++row)
      for (std::uint32_t column = std::max(x, 1u) - 1; column <= std::min(x + 1, nx_ - 1); ++column)
        visit(row * nx_ + column);
  }

  /// Whether two patches are the same or beside each other on one cloth.
  bool beside(std::uint32_t a, std::uint32_t b) const {
    return close_by(a % nx_, b % nx_) && close_by(a / nx_, b / nx_) && a / nx_ / ny_ == b / nx_ / ny_;
  }

 private:
  static bool close_by(std::uint32_t x, std::uint32_t y) { return x + 1 >= y && x <= y + 1; }

  const Grid& grid_;
  std::uint32_t nx_, ny_;
};

/// One invocation a patch.
Range patch_domain(const Model& model);

/// One invocation a block.
Range block_domain(const Model& model);

/// Whether they are the same or neighbours on one cloth.
inline bool beside(const Grid& grid, std::uint32_t a, std::uint32_t b) {
  const auto near = [](std::uint32_t x, std::uint32_t y) { return x + 1 >= y && x <= y + 1; };
  const std::uint32_t particles = grid.nx * grid.ny;
  return near(a % grid.nx, b % grid.nx) && near(a / grid.nx, b / grid.nx) && a / particles == b / particles;
}

/// Calls visit(particle) for each that looks for others, in threads.
template <class T, class Visit>
void each_looker(const CollisionView<T>& view, const HostWords& buffers, Visit&& visit) {
  constexpr std::uint32_t kAtOnce = 64;  // particles
  const auto& lookers = buffers.words_of(BufferId::lookers);
  const std::uint32_t count = buffers.words_of(BufferId::collision_state)[shared::kLookers];
  parallel_rows((count + kAtOnce - 1) / kAtOnce, kAtOnce, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t k = begin * kAtOnce; k < std::min(end * kAtOnce, count); ++k)
      visit(view.particle_at(lookers[k]));
  });
}

/// What the searches read: blocks in a grid, the boxes of them and of their patches, and how far to look.
template <class T>
class PatchSearch {
 public:
  using V = glm::vec<3, T>;
  using Cell = typename CollisionView<T>::Cell;

  PatchSearch(const CollisionView<T>& view, const HostBuffers<T>& buffers)
      : view_(view),
        boxes_(buffers[BufferId::patches]),
        blocks_(buffers[BufferId::blocks]),
        cells_(buffers.words_of(BufferId::cells)),
        members_(buffers.words_of(BufferId::cell_members)) {
    const auto& state = buffers.words_of(BufferId::collision_state);
    const auto known = [&](std::uint32_t word) { return static_cast<T>(std::bit_cast<float>(state[word])); };
    surface_squared_ = (view.surface_reach_squared + T(0.5) * known(shared::kLongestEdge)) * kRoom;
    search_ = std::max(std::sqrt(surface_squared_), view.pair_reach) * kRoom;
    widest_ = known(shared::kWidestBlock);
  }

  T surface_squared() const { return surface_squared_; }  ///< between corners of two surfaces within reach
  T surface_distance() const { return std::sqrt(surface_squared_) * kRoom; }
  T distance() const { return search_; }  ///< of particles that some list may have

  V low(std::uint32_t patch) const { return V(boxes_[2 * std::size_t{patch}]); }
  V high(std::uint32_t patch) const { return V(boxes_[2 * std::size_t{patch} + 1]); }

  V block_low(std::uint32_t block) const { return V(blocks_[2 * std::size_t{block}]); }
  V block_high(std::uint32_t block) const { return V(blocks_[2 * std::size_t{block} + 1]); }

  Cell cell_of(std::uint32_t block) const {
    const V low = block_low(block), high = block_high(block);
    if (!view_.covered({low, T(0)}) || !view_.covered({high, T(0)}))
      return {static_cast<std::int32_t>(block), 0x40000000, 0x40000000};
    return view_.cell_of({T(0.5) * (low + high), T(0)});
  }

  /// How many cells beyond a box those are that have the middles of blocks with a particle within `search`.
  T cells_beyond(T search) const {
    const T far = search + kHalfRoom * widest_;
    return std::min(far * view_.inverse_cell, static_cast<T>(shared::kCellsFromOriginMax));
  }

  /// The largest gap between two boxes along an axis; less than 0 where they overlap.
  static T gap(const V& low_a, const V& high_a, const V& low_b, const V& high_b) {
    const V before = low_b - high_a, after = low_a - high_b;
    T most = std::max(before.x, after.x);
    for (int axis = 1; axis < 3; ++axis) most = std::max(most, std::max(before[axis], after[axis]));
    return most;
  }

  /// Cells, both ends included, and whether those are all that were asked for.
  struct CellRange {
    Cell first{}, last{};
    bool all = true;
    bool has(const Cell& cell) const {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (cell[axis] < first[axis] || cell[axis] > last[axis]) return false;
      return true;
    }
  };
  /// The cells in which blocks' middles are that have a particle within `search` of the box, as many along an
  /// axis at most.
  CellRange cells_around(const V& low, const V& high, T search,
                         int across_max = shared::kCellsAcrossMax) const {
    const T far_cells = cells_beyond(search);
    CellRange range;
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::size_t>(axis);
      const T begin = std::floor(low[axis] * view_.inverse_cell - far_cells),
              end = std::floor(high[axis] * view_.inverse_cell + far_cells);
      const T cut = std::min(end, begin + static_cast<T>(across_max - 1));
      range.first[at] = static_cast<std::int32_t>(begin);
      range.last[at] = static_cast<std::int32_t>(cut);
      range.all &= cut == end;
    }
    return range;
  }

  /// Calls visit(block, cell) for each member of the cells' buckets, cell by cell; the same block may come
  /// twice. It ends when visit returns true.
  template <class Visit>
  void each_member(const CellRange& cells, Visit&& visit) const {
    for (std::int32_t z = cells.first[2]; z <= cells.last[2]; ++z)
      for (std::int32_t y = cells.first[1]; y <= cells.last[1]; ++y)
        for (std::int32_t x = cells.first[0]; x <= cells.last[0]; ++x) {
          const std::uint32_t bucket = view_.bucket_of({x, y, z});
          for (std::uint32_t slot = cells_[bucket]; slot < cells_[bucket + 1]; ++slot)
            if (visit(members_[slot], Cell{x, y, z})) return;
        }
  }

  /// Calls visit(block) for each member of the buckets of the cells in which blocks' middles are that have a
  /// particle within `search` of the box; the same may come twice. It ends when visit returns true.
  /// @return whether those were all cells
  template <class Visit>
  bool around(const V& low, const V& high, T search, Visit&& visit) const {
    const CellRange cells = cells_around(low, high, search);
    each_member(cells, [&](std::uint32_t block, const Cell&) { return visit(block); });
    return cells.all;
  }

  /// Calls visit(q) for the particles of the patches that may have one within `search` of p, but for p and
  /// its neighbours. @return as around()
  template <class Visit>
  bool particles_around(const PatchGrid& patches, std::uint32_t p, const V& x, T search,
                        Visit&& visit) const {
    const Grid& grid = view_.grid;
    const std::uint32_t column = p % grid.nx, row = p / grid.nx, cloth = row / grid.ny;
    const auto close_by = [](std::uint32_t a, std::uint32_t b) { return a + 1 >= b && a <= b + 1; };
    const auto look_into = [&](std::uint32_t patch) {
      if (!(gap(x, x, low(patch), high(patch)) < search)) return;
      const PatchGrid::Block block = patches.block(patch);
      const bool own_cloth = block.j0 / grid.ny == cloth;
      for (std::uint32_t j = block.j0; j <= block.j1; ++j)
        for (std::uint32_t i = block.i0; i <= block.i1; ++i)
          if (!(own_cloth && close_by(i, column) && close_by(j, row))) visit(grid.index(i, j));
    };
    const CellRange cells = cells_around(x, x, search);
    // Which cell a block is in costs more to say than whether it is near: asked last. One that is looked into
    // only where its own cell asks for its bucket is looked into once.
    each_member(cells, [&](std::uint32_t other, const Cell& cell) {
      if (gap(x, x, block_low(other), block_high(other)) < search && cell_of(other) == cell)
        patches.each_of(patches.patches_of(other), look_into);
      return false;
    });
    return cells.all;
  }

 private:
  static constexpr T kRoom = static_cast<T>(1.0009765625), kHalfRoom = static_cast<T>(0.5009765625);

  const CollisionView<T>& view_;
  const std::vector<glm::vec<4, T>>&boxes_, &blocks_;
  const std::vector<std::uint32_t>&cells_, &members_;
  T surface_squared_, search_, widest_;
};

}  // namespace weft
