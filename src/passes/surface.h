// What the mirrors of self-collision's surfaces share: a particle's ring of neighbours, closest points, and
// an entry of a list. Operation by operation as docs/float-form.md "Surfaces".
#pragma once
#include <array>
#include <optional>

#include "passes/collision.h"
#include "passes/contact.h"

namespace weft {

/// The six neighbours that a particle shares edges with, in a circle.
struct RingOffset {
  int i, j;
};
inline constexpr std::array<RingOffset, 6> kRingOffsets{{{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}}};

/// The k-th neighbour of (i, j), counted round and round; nothing outside its cloth.
inline std::optional<std::uint32_t> ring_particle(const Grid& grid, std::uint32_t particle, std::size_t k) {
  const RingOffset off = kRingOffsets[k % 6];
  const std::uint32_t row = particle / grid.nx, own = grid.own_row(row);
  const auto i = static_cast<std::int64_t>(particle % grid.nx) + off.i,
             j = static_cast<std::int64_t>(own) + off.j;
  if (i < 0 || j < 0 || i >= std::int64_t{grid.nx} || j >= std::int64_t{grid.ny}) return std::nullopt;
  return grid.index(static_cast<std::uint32_t>(i), row - own + static_cast<std::uint32_t>(j));
}

template <class T>
glm::vec<3, T> place_in(const std::vector<glm::vec<4, T>>& position, std::uint32_t particle) {
  return glm::vec<3, T>(position[particle]);
}

/// Weights of the corners at the triangle's point nearest to p. Source: Ericson 2005, section 5.1.5.
template <class T>
glm::vec<3, T> nearest_in_triangle(const glm::vec<3, T>& p, const std::array<glm::vec<3, T>, 3>& corner) {
  using V = glm::vec<3, T>;
  const V ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const V ap = p - corner[0], bp = p - corner[1], cp = p - corner[2];
  const T d1 = dot3(ab, ap), d2 = dot3(ac, ap), d3 = dot3(ab, bp), d4 = dot3(ac, bp), d5 = dot3(ab, cp),
          d6 = dot3(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const T vc = d1 * d4 - d3 * d2, along = d1 - d3;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && along > 0) {  // not where the two corners lie on each other
    const T v = d1 / along;
    return {T(1) - v, v, 0};
  }
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const T vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const T w = d2 / (d2 - d6);
    return {T(1) - w, 0, w};
  }
  const T va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const T w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, T(1) - w, w};
  }
  const T sum = (va + vb) + vc, v = vb / sum, w = vc / sum;
  return {(T(1) - v) - w, v, w};
}

/// How far along the edges a–b and e–f their nearest points are. Source: Ericson 2005, section 5.1.9.
template <class T>
std::array<T, 2> nearest_on_edges(const glm::vec<3, T>& a, const glm::vec<3, T>& b, const glm::vec<3, T>& e,
                                  const glm::vec<3, T>& f) {
  const auto share = [](T x) { return std::min(std::max(x, T(0)), T(1)); };
  const T tiny = static_cast<T>(shared::kEdgeTiny_m2);
  const T aa = std::max(dot3(b - a, b - a), tiny), ee = std::max(dot3(f - e, f - e), tiny);
  const T mixed = dot3(b - a, f - e), ar = dot3(b - a, a - e), er = dot3(f - e, a - e);
  const T det = aa * ee - mixed * mixed;
  const T s = det > 0 ? share((mixed * er - ar * ee) / det) : T(0);
  const T t = (mixed * s + er) / ee;
  if (t < 0) return {share(-ar / aa), T(0)};
  if (t > 1) return {share((mixed - ar) / aa), T(1)};
  return {s, t};
}

/// Particles, the weights of their motion in the distance, and the way from the second side to the first.
template <class T>
struct SurfacePair {
  std::array<std::uint32_t, 4> particle;
  std::array<T, 4> weight;
  bool edges;
  glm::vec<3, T> d;
  T squared;
};

/// A particle and a triangle.
template <class T>
SurfacePair<T> particle_and_triangle(const std::vector<glm::vec<4, T>>& position,
                                     const std::array<std::uint32_t, 4>& particle) {
  const auto p = place_in(position, particle[0]);
  const std::array corner{place_in(position, particle[1]), place_in(position, particle[2]),
                          place_in(position, particle[3])};
  const auto weight = nearest_in_triangle(p, corner);
  const auto foot = weight.y * (corner[1] - corner[0]) + weight.z * (corner[2] - corner[0]);
  const auto d = (p - corner[0]) - foot;
  return {particle, {T(1), -weight.x, -weight.y, -weight.z}, false, d, dot3(d, d)};
}

/// Two edges.
template <class T>
SurfacePair<T> edge_and_edge(const std::vector<glm::vec<4, T>>& position,
                             const std::array<std::uint32_t, 4>& particle) {
  const auto a = place_in(position, particle[0]), b = place_in(position, particle[1]),
             e = place_in(position, particle[2]), f = place_in(position, particle[3]);
  const auto [s, t] = nearest_on_edges(a, b, e, f);
  const auto d = ((a - e) + s * (b - a)) - t * (f - e);
  return {particle, {T(1) - s, s, -(T(1) - t), -t}, true, d, dot3(d, d)};
}

/// What an entry of `particle`'s list means at these positions.
template <class T>
SurfacePair<T> surface_pair(const CollisionView<T>& view, const std::vector<glm::vec<4, T>>& position,
                            std::uint32_t particle, std::uint32_t entry) {
  const std::uint32_t code = entry >> shared::kSurfaceCodeShift;
  const std::uint32_t other = view.particle_at(entry & ((1u << shared::kSurfaceCodeShift) - 1));
  if (code >= shared::kSurfaceTriangle) {
    const std::size_t k = code - shared::kSurfaceTriangle;
    return particle_and_triangle(position, {particle, other, *ring_particle(view.grid, other, k),
                                            *ring_particle(view.grid, other, k + 1)});
  }
  return edge_and_edge(position, {particle, *ring_particle(view.grid, particle, code / 6), other,
                                  *ring_particle(view.grid, other, code % 6)});
}

/// Calls visit(pair) for every entry of every list, at near_position.
template <class T, class Visit>
void for_each_surface_pair(const CollisionView<T>& view, const HostBuffers<T>& buffers, Visit&& visit) {
  const auto& position = buffers[BufferId::near_position];
  const auto& counts = buffers.words_of(BufferId::surface_count);
  const auto& entries = buffers.words_of(BufferId::surface_pairs);
  for (std::uint32_t p = 0; p < view.grid.count(); ++p)
    for (std::size_t k = 0; k < counts[p]; ++k)
      visit(surface_pair(view, position, p, entries[k * view.grid.count() + p]));
}

}  // namespace weft
