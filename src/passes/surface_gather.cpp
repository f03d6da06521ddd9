// surface_gather: the triangles near each particle and the pairs of edges near each other. Declaration and
// CPU mirror.
#include <atomic>
#include <bit>
#include <tuple>
#include <utility>

#include "passes/parallel.h"
#include "passes/passes.h"
#include "passes/surface.h"

namespace weft {
namespace {

/// The search of one particle.
template <class T>
class SurfaceSearch {
 public:
  SurfaceSearch(const CollisionView<T>& view, const HostBuffers<T>& buffers)
      : view_(view),
        position_(buffers[BufferId::position]),
        cells_(buffers.words_of(BufferId::cells)),
        members_(buffers.words_of(BufferId::cell_members)) {
    const std::uint32_t bits = buffers.words_of(BufferId::collision_state)[shared::kLongestEdge];
    const T longest = static_cast<T>(std::bit_cast<float>(bits));
    search_ = (view.surface_reach_squared + T(0.5) * longest) * static_cast<T>(1.0009765625);
  }

  /// Calls keep(code, place) for each entry of p's list and returns whether nothing was out of its sight.
  template <class Keep>
  bool run(std::uint32_t p, Keep&& keep) const {
    const T far = std::sqrt(search_) * view_.inverse_cell;
    typename CollisionView<T>::Cell first{}, last{};
    bool all = true;
    for (int axis = 0; axis < 3; ++axis) {
      const T middle = position_[p][axis] * view_.inverse_cell;
      const T low = std::floor(middle - far), high = std::floor(middle + far);
      const auto at = static_cast<std::size_t>(axis);
      first[at] = static_cast<std::int32_t>(low);
      last[at] = static_cast<std::int32_t>(std::min(high, low + T(shared::kCellsAcrossMax - 1)));
      all &= high == static_cast<T>(last[at]);
    }
    const bool flat = stretch_around(p) >= view_.flat_min;
    for (std::int32_t z = first[2]; z <= last[2]; ++z)
      for (std::int32_t y = first[1]; y <= last[1]; ++y)
        for (std::int32_t x = first[0]; x <= last[0]; ++x) search_cell({x, y, z}, p, flat, keep);
    return all;
  }

 private:
  using Cell = typename CollisionView<T>::Cell;
  using V = glm::vec<3, T>;

  V at(std::uint32_t i, std::uint32_t j) const { return place_in(position_, view_.grid.index(i, j)); }

  T stretch_around(std::uint32_t p) const {
    const Grid& g = view_.grid;
    const std::uint32_t i = p % g.nx, j = p / g.nx;
    const std::uint32_t top = j - g.own_row(j), bottom = top + g.ny - 1;  // of its own cloth
    const std::uint32_t right = std::min(i + 1, g.nx - 1), below = std::min(j + 1, bottom);
    const V along = at(right, j) - at(right - 1, j), down = at(i, below) - at(i, below - 1);
    T off_i = 0, off_j = 0;
    const std::uint32_t i_end = std::min(i + 2, g.nx - 1), j_end = std::min(j + 2, bottom);
    for (std::uint32_t y = j < top + 2 ? top : j - 2; y <= j_end; ++y)
      for (std::uint32_t x = i < 2 ? 0 : i - 2; x <= i_end; ++x) {
        const V i_edge = x < i_end ? (at(x + 1, y) - at(x, y)) - along : V(0),
                j_edge = y < j_end ? (at(x, y + 1) - at(x, y)) - down : V(0);
        off_i = std::max(off_i, dot3(i_edge, i_edge));
        off_j = std::max(off_j, dot3(j_edge, j_edge));
      }
    const T a = dot3(along, along), b = dot3(down, down), m = dot3(along, down);
    const T middle = T(0.5) * (a + b), half = T(0.5) * (a - b);
    const T root = std::sqrt(half * half + m * m);
    return std::sqrt(std::max(middle - root, T(0))) - std::sqrt(off_i + off_j);
  }

  bool same_cloth(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t particles = view_.grid.nx * view_.grid.ny;
    return a / particles == b / particles;
  }

  /// What orders pairs of corners: distance, then places.
  std::tuple<T, std::uint32_t, std::uint32_t> order_of(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t pa = view_.place_of(a), pb = view_.place_of(b);
    return {squared_distance(position_[a], position_[b]), std::min(pa, pb), std::max(pa, pb)};
  }
  /// Whether (a, b) comes strictly first, as the shader's comparisons have it where distances are numbers.
  bool stands_for(std::uint32_t a, std::uint32_t b, std::uint32_t e, std::uint32_t f) const {
    return order_of(a, b) < order_of(e, f);
  }

  template <class Keep>
  void search_cell(const Cell& cell, std::uint32_t p, bool flat, Keep&& keep) const {
    const std::uint32_t bucket = view_.bucket_of(cell), nx = view_.grid.nx;
    const auto near = [](std::uint32_t a, std::uint32_t b) { return (a > b ? a - b : b - a) <= 1; };
    for (std::uint32_t slot = cells_[bucket]; slot < cells_[bucket + 1]; ++slot) {
      const std::uint32_t q = view_.particle_at(members_[slot]);
      if (q == p || (flat && near(p % nx, q % nx) && near(p / nx, q / nx) && same_cloth(p, q))) continue;
      if (!(squared_distance(position_[p], position_[q]) < search_)) continue;
      if (view_.cell_of(position_[q], q) != cell) continue;
      add_triangles(p, q, keep);
      const bool same = (view_.place_of(p) % 2) == (members_[slot] % 2);
      if (same == (p < q)) add_edges(p, q, keep);
    }
  }

  template <class Keep>
  void add_triangles(std::uint32_t p, std::uint32_t q, Keep&& keep) const {
    for (std::uint32_t k = 0; k < 6; ++k) {
      const auto b = ring_particle(view_.grid, q, k), c = ring_particle(view_.grid, q, k + 1);
      if (!b || !c || *b == p || *c == p || !stands_for(p, q, p, *b) || !stands_for(p, q, p, *c)) continue;
      if (particle_and_triangle(position_, {p, q, *b, *c}).squared < view_.surface_reach_squared)
        keep(shared::kSurfaceTriangle + k, view_.place_of(q));
    }
  }

  template <class Keep>
  void add_edges(std::uint32_t p, std::uint32_t q, Keep&& keep) const {
    for (std::uint32_t a = 0; a < 6; ++a) {
      const auto mine = ring_particle(view_.grid, p, a);
      if (!mine || *mine == q || !stands_for(p, q, *mine, q)) continue;
      for (std::uint32_t b = 0; b < 6; ++b) {
        const auto its = ring_particle(view_.grid, q, b);
        if (!its || *its == p || *its == *mine) continue;
        if (!stands_for(p, q, p, *its) || !stands_for(p, q, *mine, *its)) continue;
        if (edge_and_edge(position_, {p, *mine, q, *its}).squared < view_.surface_reach_squared)
          keep(a * 6 + b, view_.place_of(q));
      }
    }
  }

  const CollisionView<T>& view_;
  const std::vector<glm::vec<4, T>>& position_;
  const std::vector<std::uint32_t>&cells_, &members_;
  T search_;
};

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_stale(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  const std::size_t count = grid.count();
  auto& counts = buffers.words_of(BufferId::surface_count);
  auto& entries = buffers.words_of(BufferId::surface_pairs);
  counts.resize(count);
  entries.resize(count * view.layout.surface_capacity);
  const SurfaceSearch<T> search(view, buffers);
  std::atomic<std::uint32_t> dropped = 0, listed = 0;
  parallel_rows(grid.rows(), grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      std::uint32_t found = 0;
      const auto keep = [&](std::uint32_t code, std::uint32_t place) {
        if (found < view.layout.surface_capacity)
          entries[found * count + p] = code << shared::kSurfaceCodeShift | place;
        ++found;
      };
      if (view.covered(std::as_const(buffers)[BufferId::position][p]) && !search.run(p, keep)) ++dropped;
      counts[p] = std::min(found, view.layout.surface_capacity);
      dropped += found - counts[p];
      listed |= counts[p];
    }
  });
  buffers.words_of(BufferId::surface_bound).assign(count, shared::kInfinity);
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kPairsDropped] += dropped;
  state[shared::kListGroups] = state[shared::kScanGroups] = 0;
  if (listed != 0) mark_listed(grid, buffers);
}

}  // namespace

const Pass surface_gather =
    collision_pass("surface_gather", "self-collision: lists of near triangles and edges", mirror<float>,
                   mirror<double>, shared::kListGroups);

}  // namespace weft
