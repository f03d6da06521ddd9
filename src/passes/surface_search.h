// The search of one particle for the triangles near it and the edges near its own: what surface_gather's
// mirror and native share. Operation by operation as docs/float-form.md "Surfaces".
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "passes/folds.h"
#include "passes/patches.h"

namespace weft {

/// A particle, where it is, and those round it that it shares edges with.
struct Ringed {
  std::uint32_t particle, i, own_row;
  std::array<std::uint32_t, 6> ring;
  std::uint32_t there;  ///< a bit for each of the ring that its cloth has
};

inline Ringed ringed(const Grid& grid, std::uint32_t particle, std::uint32_t column, std::uint32_t own_row) {
  Ringed at{particle, column, own_row, {}, 0};
  for (std::size_t k = 0; k < 6; ++k) {
    const RingOffset off = kRingOffsets[k];
    const auto i = static_cast<std::uint32_t>(static_cast<int>(at.i) + off.i),
               j = static_cast<std::uint32_t>(static_cast<int>(at.own_row) + off.j);  // −1: beyond any
    if (i >= grid.nx || j >= grid.ny) continue;
    at.ring[k] = particle + static_cast<std::uint32_t>(off.j * static_cast<int>(grid.nx) + off.i);
    at.there |= 1u << k;
  }
  return at;
}

inline Ringed ringed(const Grid& grid, std::uint32_t particle) {
  const std::uint32_t row = particle / grid.nx;
  return ringed(grid, particle, particle - row * grid.nx, grid.own_row(row));
}

/// Of the eight round a particle, row by row: of its four cells, row by row, those that have both.
inline constexpr std::array<std::uint32_t, 8> kCellsWithBoth{1, 3, 2, 5, 10, 4, 12, 8};

/// The search of one particle.
template <class T>
class SurfaceSearch {
 public:
  SurfaceSearch(const CollisionView<T>& view, const PatchGrid& patches, const HostBuffers<T>& buffers)
      : view_(view),
        patches_(patches),
        position_(buffers[BufferId::position]),
        folded_(view.grid, patches, buffers[BufferId::patches]),
        search_(view, buffers) {}

  const PatchSearch<T>& search() const { return search_; }

  /// Calls keep(code, place) for each entry of p's list and returns whether nothing was out of its sight.
  /// @param looks   the word of its patch in patch_listed
  /// @param around  calls its argument for those that may be near p, as PatchSearch::particles_around
  template <class Around, class Keep>
  bool run(std::uint32_t p, std::uint32_t looks, Around&& around, Keep&& keep) const {
    const Ringed at = ringed(view_.grid, p);
    const auto is_near = [&](std::uint32_t q) {
      return squared_distance(position_[p], position_[q]) < search_.surface_squared();
    };
    const auto look_at = [&](std::uint32_t q) {
      if (is_near(q)) add(at, ringed(view_.grid, q), keep);
    };
    const auto look_at_beside = [&](std::uint32_t q, std::uint32_t i, std::uint32_t own_row) {
      if (is_near(q)) add(at, ringed(view_.grid, q, i, own_row), keep);
    };
    if ((looks >> (at.own_row % 2 * 2 + at.i % 2) & shared::kLooksBeside) != 0)
      look_beside(at, looks, look_at_beside);
    return (looks & shared::kLooksFar) == 0 || around(look_at);
  }

 private:
  template <class LookAt>
  void look_beside(const Ringed& at, std::uint32_t looks, LookAt&& look_at) const {
    const bool all = (looks & shared::kCreaseBeside) != 0;
    const std::uint32_t folded = all ? 15u : folded_.around(at.particle);
    for (std::uint32_t k = 0; k < 8; ++k) {
      if ((folded & kCellsWithBoth[k]) != kCellsWithBoth[k]) continue;
      const std::uint32_t place = k < 4 ? k : k + 1, across = place % 3, down = place / 3;
      const std::uint32_t i = at.i + across - 1, own_row = at.own_row + down - 1;  // −1: beyond any
      if (i < view_.grid.nx && own_row < view_.grid.ny)
        look_at(at.particle + down * view_.grid.nx + across - view_.grid.nx - 1, i, own_row);
    }
  }

  /// What orders pairs of corners: distance, then places, which ascend as particles do.
  struct Order {
    T squared;
    std::uint32_t low, high;
  };
  Order order_of(std::uint32_t a, std::uint32_t b) const {
    return {squared_distance(position_[a], position_[b]), std::min(a, b), std::max(a, b)};
  }
  /// Whether `a` comes strictly first, as the shader's comparisons have it where distances are numbers.
  static bool first(const Order& a, const Order& b) {
    if (a.squared != b.squared) return a.squared < b.squared;
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  }

  template <class Keep>
  void add(const Ringed& p, const Ringed& q, Keep&& keep) const {
    const Order nearest = order_of(p.particle, q.particle);
    const bool edges = (p.i % 2 == q.i % 2) == (p.particle < q.particle);
    std::uint32_t farther = 0;  // of those round q, which are farther from p than q
    std::array<T, 6> turn{};
    for (std::size_t k = 0; k < 6; ++k) {
      if ((q.there >> k & 1u) == 0 || q.ring[k] == p.particle) continue;
      const Order other = order_of(p.particle, q.ring[k]);
      if (!first(nearest, other)) continue;
      farther |= 1u << k;
      if (edges) turn[k] = turn_of(nearest.squared, other.squared, q.particle, q.ring[k]);
    }
    add_triangles(p, q, farther, keep);
    if (edges && farther != 0) add_edges(p, q, nearest, farther, turn, keep);
  }

  /// How much an edge from one of two corners may take off the square of their distance, and what rounding
  /// may: 0 or less. The square of the distance of two edges is a convex function of the places on them, so
  /// that it is at least c + min(0, c₁ − c − e²) + min(0, c₂ − c − f²): c from corner to corner, c₁ and c₂ to
  /// the other ends, e and f the edges.
  /// @param squared, end_squared  c and c₁ [m²]
  T turn_of(T squared, T end_squared, std::uint32_t corner, std::uint32_t end) const {
    const T edge = squared_distance(position_[corner], position_[end]);
    return std::min((end_squared - squared) - edge, T(0)) - kRounding * (end_squared + edge);
  }

  template <class Keep>
  void add_triangles(const Ringed& p, const Ringed& q, std::uint32_t farther, Keep&& keep) const {
    for (std::uint32_t k = 0; k < 6; ++k) {
      const std::uint32_t next = (k + 1) % 6;
      if ((farther >> k & farther >> next & 1u) == 0) continue;
      const std::array corners{p.particle, q.particle, q.ring[k], q.ring[next]};
      if (particle_and_triangle(position_, corners).squared < view_.surface_reach_squared)
        keep(shared::kSurfaceTriangle + k, view_.place_of(q.particle));
    }
  }

  template <class Keep>
  void add_edges(const Ringed& p, const Ringed& q, const Order& nearest, std::uint32_t farther,
                 const std::array<T, 6>& turn, Keep&& keep) const {
    for (std::uint32_t a = 0; a < 6; ++a) {
      const std::uint32_t mine = p.ring[a];
      if ((p.there >> a & 1u) == 0 || mine == q.particle) continue;
      const Order other = order_of(mine, q.particle);
      if (!first(nearest, other)) continue;
      const T least = nearest.squared + turn_of(nearest.squared, other.squared, p.particle, mine);
      for (std::uint32_t b = 0; b < 6; ++b) {
        if ((farther >> b & 1u) == 0 || least + turn[b] > kOut * view_.surface_reach_squared) continue;
        const std::uint32_t its = q.ring[b];
        if (its == mine || !first(nearest, order_of(mine, its))) continue;
        if (edge_and_edge(position_, {p.particle, mine, q.particle, its}).squared <
            view_.surface_reach_squared)
          keep(a * 6 + b, view_.place_of(q.particle));
      }
    }
  }

  static constexpr T kRounding = static_cast<T>(1e-5), kOut = static_cast<T>(1.01);  // far above any
  const CollisionView<T>& view_;
  const PatchGrid& patches_;
  const std::vector<glm::vec<4, T>>& position_;
  FoldedCells<T> folded_;
  PatchSearch<T> search_;
};

}  // namespace weft
