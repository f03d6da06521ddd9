// surface_gather: the triangles near each particle and the pairs of edges near each other. Declaration and
// CPU mirror.
#include <atomic>
#include <tuple>
#include <utility>

#include "passes/folds.h"
#include "passes/parallel.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// The search of one particle.
template <class T>
class SurfaceSearch {
 public:
  SurfaceSearch(const CollisionView<T>& view, const PatchGrid& patches, const HostBuffers<T>& buffers)
      : view_(view),
        patches_(patches),
        position_(buffers[BufferId::position]),
        listed_(buffers.words_of(BufferId::patch_listed)),
        folded_(view.grid, patches, buffers[BufferId::patches]),
        search_(view, buffers) {}

  /// Calls keep(code, place) for each entry of p's list and returns whether nothing was out of its sight.
  template <class Keep>
  bool run(std::uint32_t p, Keep&& keep) const {
    const auto look_at = [&](std::uint32_t q) {
      if (squared_distance(position_[p], position_[q]) < search_.surface_squared()) add(p, q, keep);
    };
    const std::uint32_t looks = listed_[patches_.with(p)];
    const std::uint32_t in_patch = view_.grid.own_row(p / view_.grid.nx) % 2 * 2 + p % view_.grid.nx % 2;
    if ((looks >> in_patch & shared::kLooksBeside) != 0)
      for (std::uint32_t k = 0; k < 8; ++k)
        if (const auto q = beside_at(view_.grid, p, k))
          if ((looks & shared::kCreaseBeside) != 0 || folded_.all_between(p, *q)) look_at(*q);
    if ((looks & shared::kLooksFar) == 0) return true;
    return search_.particles_around(patches_, p, place_in(position_, p), search_.surface_distance(), look_at);
  }

 private:
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
  void add(std::uint32_t p, std::uint32_t q, Keep&& keep) const {
    add_triangles(p, q, keep);
    const bool same = (view_.place_of(p) % 2) == (view_.place_of(q) % 2);
    if (same == (p < q)) add_edges(p, q, keep);
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
  const PatchGrid& patches_;
  const std::vector<glm::vec<4, T>>& position_;
  const std::vector<std::uint32_t>& listed_;
  FoldedCells<T> folded_;
  PatchSearch<T> search_;
};

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!lists_in_making(buffers)) return;
  const CollisionView<T> view(context.model);
  const Grid& grid = context.model.grid;
  const std::size_t count = grid.count();
  auto& counts = buffers.words_of(BufferId::surface_count);
  auto& entries = buffers.words_of(BufferId::surface_pairs);
  entries.resize(count * view.layout.surface_capacity);
  const PatchGrid patches(grid);
  const SurfaceSearch<T> search(view, patches, buffers);
  std::atomic<std::uint32_t> dropped = 0, listed = 0;
  each_looker(view, buffers, [&](std::uint32_t p) {
    if (!view.covered(std::as_const(buffers)[BufferId::position][p])) return;
    std::uint32_t found = 0;
    const auto keep = [&](std::uint32_t code, std::uint32_t place) {
      if (found < view.layout.surface_capacity)
        entries[found * count + p] = code << shared::kSurfaceCodeShift | place;
      ++found;
    };
    if (!search.run(p, keep)) ++dropped;
    counts[p] = std::min(found, view.layout.surface_capacity);
    dropped += found - counts[p];
    listed |= counts[p];
  });
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kPairsDropped] += dropped;
  for (const std::uint32_t word :
       {shared::kListGroups, shared::kBlockGroups, shared::kNearGroups, shared::kScanGroups})
    state[word] = 0;
  if (listed != 0) mark_listed(grid, buffers);
}

}  // namespace

const Pass surface_gather = list_pass("surface_gather", "self-collision: lists of near triangles and edges",
                                      mirror<float>, mirror<double>, shared::kNearGroups);

}  // namespace weft
