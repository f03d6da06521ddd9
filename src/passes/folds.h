// Where the cloth bends so much that it may come within reach of itself from one cell to the next. What the
// mirrors of the passes that make lists share. Operation by operation as docs/float-form.md "Folds".
#pragma once
#include <array>
#include <utility>

#include "passes/patches.h"
#include "passes/surface.h"

namespace weft {

/// Two unit vectors at right angles, as near as they come to the edges of a piece of the cloth.
template <class T>
struct Frame {
  glm::vec<3, T> along, down;
};

/// @param along, down  anything in these directions [m]; without length the frame holds no numbers
template <class T>
Frame<T> frame_of(const glm::vec<3, T>& along, const glm::vec<3, T>& down) {
  using V = glm::vec<3, T>;
  const T half_root = static_cast<T>(shared::kHalfRoot);
  const V a = along * (T(1) / std::sqrt(dot3(along, along))), b = down * (T(1) / std::sqrt(dot3(down, down)));
  const V sum = a + b, rest = a - b;
  const V u = sum * (half_root / std::sqrt(dot3(sum, sum))),
          w = rest * (half_root / std::sqrt(dot3(rest, rest)));
  return {u + w, u - w};
}

/// A patch and the two particles next to it on every side: the tests that say what there is out of reach.
/// Beyond the cloth's ends its last particle stands again.
template <class T>
class Folds {
 public:
  using V = glm::vec<3, T>;
  Folds(const CollisionView<T>& view, const PatchGrid& patches, const std::vector<glm::vec<4, T>>& position,
        std::uint32_t patch)
      : view_(view) {
    const PatchGrid::Block own = patches.block(patch);
    const auto top = static_cast<int>(own.j0 - view.grid.own_row(own.j0));
    const int i0 = static_cast<int>(own.i0) - 2, j0 = static_cast<int>(own.j0) - 2,
              right = static_cast<int>(view.grid.nx) - 1, bottom = top + static_cast<int>(view.grid.ny) - 1;
    first_ = {std::max(-i0, 0), std::max(top - j0, 0)};
    last_ = {std::min(right - i0, kAcross - 1), std::min(bottom - j0, kAcross - 1)};
    for (int j = 0; j < kAcross; ++j)
      for (int i = 0; i < kAcross; ++i)
        x_[j * kAcross + i] =
            place_in(position, view.grid.index(static_cast<std::uint32_t>(std::clamp(i0 + i, 0, right)),
                                               static_cast<std::uint32_t>(std::clamp(j0 + j, top, bottom))));
  }

  /// Whether two particles that are not beside each other, of the patch and of those beside it, may be on one
  /// of its lists: one of them in the patch.
  bool close() const {
    for (int j = first_[1]; j <= last_[1]; ++j)
      for (int i = first_[0]; i <= last_[0]; ++i)
        for (int k = 0; k < 4; ++k) {
          const int p = 2 + k % 2, q = 2 + k / 2;
          if ((std::abs(i - p) <= 1 && std::abs(j - q) <= 1) || !is_there({p, q})) continue;
          const V d = at({i, j}) - at({p, q});
          if ((d.x * d.x + d.y * d.y) + d.z * d.z < view_.patch_search_squared) return true;
        }
    return false;
  }

  /// Of the cells whose first particles are in the patch: a bit for each that is folded, and kCreased.
  std::uint32_t bends() const {
    std::uint32_t bits = 0;
    for (int k = 0; k < 4; ++k) {
      const Place cell{2 + k % 2, 2 + k / 2};
      if (!is_there({cell[0] + 1, cell[1] + 1})) continue;
      if (folded(cell)) bits |= 1u << k;
      if (creased(cell)) bits |= shared::kCreased;
    }
    return bits;
  }

  /// Whether the diagonal of the patch's k-th cell, or a triangle at it, is in reach of the cell's other two
  /// corners or the edges that leave them: what decides where no planes part them.
  bool diagonal_in_reach(std::uint32_t k) const {
    return diagonal_in_reach(Place{2 + static_cast<int>(k % 2), 2 + static_cast<int>(k / 2)});
  }

 private:
  using Place = std::array<int, 2>;  // column and row, the patch's first particle at (2, 2)
  static constexpr int kAcross = 6;
  static constexpr T kRoom = static_cast<T>(1.0009765625);
  /// The edges from a cell's first particle, and from its last, that do not touch the diagonal.
  static constexpr std::array<std::size_t, 4> kFromFirst{2, 3, 4, 5}, kFromLast{0, 1, 2, 5};

  const V& at(const Place& p) const { return x_[p[1] * kAcross + p[0]]; }
  bool is_there(const Place& p) const {
    return p[0] >= first_[0] && p[0] <= last_[0] && p[1] >= first_[1] && p[1] <= last_[1];
  }

  /// Whether the cloth within a cell of this cell (its first particle) bends so much that surfaces at least a
  /// cell apart on it may be in reach of each other.
  bool folded(const Place& cell) const {
    const int i0 = cell[0] - 1, j0 = cell[1] - 1, i1 = i0 + 3, j1 = j0 + 3;
    const V first = at({i0, j0}), beyond = at({i1, j0}), under = at({i0, j1}), last = at({i1, j1});
    const Frame<T> frame = frame_of<T>((beyond - first) + (last - under), (under - first) + (last - beyond));
    for (int j = std::max(j0, first_[1]); j < std::min(j1, last_[1]); ++j)
      for (int i = std::max(i0, first_[0]); i < std::min(i1, last_[0]); ++i)
        if (!goes_along(frame, {i, j})) return true;
    return false;
  }

  /// Whether both triangles of a cell take every direction on the cloth to one that goes on by flat_min a
  /// cell at least where the frame has it.
  bool goes_along(const Frame<T>& frame, const Place& cell) const {
    const auto [i, j] = cell;
    const V &here = at({i, j}), &right = at({i + 1, j}), &below = at({i, j + 1}),
            &across = at({i + 1, j + 1});
    const auto triangle = [&](const V& edge_i, const V& edge_j) {
      const T a = dot3(frame.along, edge_i) - view_.flat_min, b = dot3(frame.down, edge_j) - view_.flat_min;
      const T mixed = T(0.5) * (dot3(frame.along, edge_j) + dot3(frame.down, edge_i));
      return a >= 0 && b >= 0 && a * b >= mixed * mixed;
    };
    return triangle(right - here, below - here) && triangle(across - below, across - right);
  }

  /// Whether the cell's diagonal, or a triangle at it, may be in reach of what it lies less than a cell from
  /// on the cloth without touching it: the cell's other two corners and the edges that leave them.
  bool creased(const Place& cell) const { return !apart(cell) && diagonal_in_reach(cell); }

  static Place next(const Place& p, int i, int j) { return {p[0] + i, p[1] + j}; }
  template <class Visit>
  void each_end(const Place& from, const std::array<std::size_t, 4>& ends, Visit&& visit) const {
    for (const std::size_t k : ends)
      if (const Place to = next(from, kRingOffsets[k].i, kRingOffsets[k].j); is_there(to)) visit(at(to));
  }

  /// Whether three planes across the way from the cell's first particle to its last, flat_min apart, part the
  /// diagonal from all that leaves the two.
  bool apart(const Place& cell) const {
    const V here = at(cell), way = at(next(cell, 1, 1)) - here;
    const auto on = [&](const V& x) { return dot3(way, x - here); };
    const T right = on(at(next(cell, 1, 0))), below = on(at(next(cell, 0, 1)));
    T before = T(0), after = on(at(next(cell, 1, 1)));
    each_end(cell, kFromFirst, [&](const V& x) { before = std::max(before, on(x)); });
    each_end(next(cell, 1, 1), kFromLast, [&](const V& x) { after = std::min(after, on(x)); });
    const T room = view_.flat_min * std::sqrt(dot3(way, way));
    return std::min(right, below) - before > room && after - std::max(right, below) > room;
  }

  bool diagonal_in_reach(const Place& cell) const {
    const T squared = view_.surface_reach_squared * kRoom;
    const V here = at(cell), right = at(next(cell, 1, 0)), below = at(next(cell, 0, 1)),
            last = at(next(cell, 1, 1));
    const auto near = [&](const V& d) { return dot3(d, d) < squared; };
    const auto triangle = [&](const V& p, const std::array<V, 3>& corner) {
      const V weight = nearest_in_triangle(p, corner);
      return near((p - corner[0]) -
                  (weight.y * (corner[1] - corner[0]) + weight.z * (corner[2] - corner[0])));
    };
    bool found = triangle(here, {right, below, last}) || triangle(last, {here, right, below});
    const auto look = [&](const Place& from, const std::array<std::size_t, 4>& ends) {
      const V e = at(from);
      each_end(from, ends, [&](const V& f) {
        const auto [s, t] = nearest_on_edges(right, below, e, f);
        found |= near(((right - e) + s * (below - right)) - t * (f - e));
      });
    };
    look(cell, kFromFirst);
    look(next(cell, 1, 1), kFromLast);
    return found;
  }

  const CollisionView<T>& view_;
  std::array<V, std::size_t{kAcross} * kAcross> x_;
  Place first_{}, last_{};  // of those that the cloth has
};

/// What cell_count found out about a patch, in the high corner's w of its box: shared::kFoldedCells and more.
template <class T>
std::uint32_t folds_in(const std::vector<glm::vec<4, T>>& boxes, std::uint32_t patch) {
  return static_cast<std::uint32_t>(boxes[2 * std::size_t{patch} + 1].w);
}

/// Which cells are folded, as cell_count has said of each patch.
template <class T>
class FoldedCells {
 public:
  FoldedCells(const Grid& grid, const PatchGrid& patches, const std::vector<glm::vec<4, T>>& boxes)
      : grid_(grid), patches_(patches), boxes_(boxes) {}

  /// Whether one of the cells round a particle is.
  bool any_at(std::uint32_t i, std::uint32_t j) const {
    bool any = false;
    each_with({i, j}, {i, j}, [&](bool folded) { any |= folded; });
    return any;
  }
  /// Of the four cells round a particle, row by row, a bit for each that is folded or that the cloth does not
  /// have.
  std::uint32_t around(std::uint32_t particle) const {
    const std::uint32_t i = particle % grid_.nx, row = particle / grid_.nx, own = grid_.own_row(row);
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::uint32_t column = i + k % 2, down = own + k / 2;  // one more than the cell's
      const bool there = column >= 1 && column < grid_.nx && down >= 1 && down < grid_.ny;
      if (!there || is_folded(column - 1, down - 1, row - own)) bits |= 1u << k;
    }
    return bits;
  }

 private:
  using Place = std::array<std::uint32_t, 2>;  // column and row

  template <class Visit>
  void each_with(const Place& p, const Place& q, Visit&& visit) const {
    const std::uint32_t top = p[1] - grid_.own_row(p[1]);
    const auto [i0, i1] = cells(p[0], q[0], 0, grid_.nx);
    const auto [j0, j1] = cells(p[1], q[1], top, top + grid_.ny);
    for (std::uint32_t j = j0; j < j1; ++j)
      for (std::uint32_t i = i0; i < i1; ++i) visit(is_folded(i, j - top, top));
  }
  /// Of the cell of column i and row `own` of the cloth that begins at row `top`.
  bool is_folded(std::uint32_t i, std::uint32_t own, std::uint32_t top) const {
    const std::uint32_t bit = own % 2 * 2 + i % 2;
    return (folds_in(boxes_, patches_.with(grid_.index(i, top + own))) >> bit & 1u) != 0;
  }
  /// Of the cells from `first` to `end` − 1 particles along an axis, those with both, the end not included.
  static std::pair<std::uint32_t, std::uint32_t> cells(std::uint32_t p, std::uint32_t q, std::uint32_t first,
                                                       std::uint32_t end) {
    const std::uint32_t low = std::min(p, q);
    return {p != q ? low : std::max(low, first + 1) - 1, std::min(low + 1, end - 1)};
  }

  const Grid& grid_;
  const PatchGrid& patches_;
  const std::vector<glm::vec<4, T>>& boxes_;
};

}  // namespace weft
