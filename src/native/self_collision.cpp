// Hands rows of patches and of particles to the threads, and what the kernels leave over to the mirrors'
// code.
#include "native/self_collision.h"

#include <algorithm>
#include <array>

#include "passes/folds.h"
#include "passes/passes.h"
#include "passes/patches.h"

namespace weft::native {
namespace {

constexpr std::array kLooking{&cell_count};
constexpr std::uint32_t kUncoveredCell = 0x40000000;  // as PatchSearch::cell_of_box

}  // namespace

SelfCollision::SelfCollision(Cloth& cloth, const Kernels& kernels, const Model& model)
    : cloth_(cloth),
      kernels_(kernels),
      view_(model),
      buckets_(PatchGrid(model.grid).count()),
      left_over_(4 * buckets_.size()) {
  for (std::size_t j = 0; j < cloth.ny(); ++j) rows_.push_back(cloth.row(j));
}

std::uint64_t SelfCollision::bytes() const {
  return scratch_.size() * sizeof(float) + (buckets_.size() + left_over_.size()) * sizeof(std::uint32_t);
}

bool SelfCollision::has(const Pass& pass) { return std::ranges::count(kLooking, &pass) > 0; }

void SelfCollision::run(const Pass& pass, HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  if (&pass == &cell_count && lists_stale(buffers)) count_cells(buffers, crew, threads);
}

void SelfCollision::count_cells(HostBuffers<float>& buffers, Crew& crew, std::uint32_t threads) {
  const PatchGrid patches(view_.grid);
  auto& boxes = buffers[BufferId::patches];
  boxes.resize(2 * std::size_t{patches.count()});
  const std::size_t floats = patch_look_floats(cloth_.nx());
  scratch_.resize(std::max(scratch_.size(), threads * floats));
  std::vector<PatchLook> looks(threads, {.stride = cloth_.sheet().stride,
                                         .nx = cloth_.nx(),
                                         .ny = cloth_.ny(),
                                         .rows = rows_.data(),
                                         .inverse_cell = view_.inverse_cell,
                                         .cells_most = shared::kCellsFromOriginMax,
                                         .search_squared = view_.patch_search_squared,
                                         .flat_min = view_.flat_min,
                                         .bucket_mask = view_.layout.buckets - 1,
                                         .uncovered_cell = kUncoveredCell,
                                         .boxes = &boxes[0].x,
                                         .buckets = buckets_.data()});
  crew.run(threads, [&](std::uint32_t own) {
    PatchLook& look = looks[own];
    look.first = std::size_t{own} * patches.rows() / threads;
    look.last = (own + std::size_t{1}) * patches.rows() / threads;
    look.scratch = scratch_.data() + own * floats;
    look.left_over = left_over_.data() + 4 * look.first * patches.nx();
    if (look.first == look.last) return;
    look_closely({look.left_over, kernels_.look_at_patches(look)}, buffers);
  });
  auto& state = buffers.words_of(BufferId::collision_state);
  for (const PatchLook& look : looks) {
    state[shared::kLongestEdge] = std::max(state[shared::kLongestEdge], look.longest);
    state[shared::kWidestPatch] = std::max(state[shared::kWidestPatch], look.widest);
  }
  auto& cells = buffers.words_of(BufferId::cells);
  for (const std::uint32_t bucket : buckets_) ++cells[bucket];
}

/// Of cells that no three planes part, 4·patch + k each: those that are creased, with the mirror's own code.
void SelfCollision::look_closely(std::span<const std::uint32_t> cells, HostBuffers<float>& buffers) const {
  const PatchGrid patches(view_.grid);
  for (auto cell = cells.begin(); cell != cells.end();) {
    const std::uint32_t patch = *cell / 4;
    const Folds<float> folds(view_, patches, buffers[BufferId::position], patch);
    bool creased = false;
    for (; cell != cells.end() && *cell / 4 == patch; ++cell)
      creased = creased || folds.diagonal_in_reach(*cell % 4);
    if (creased) buffers[BufferId::patches][2 * std::size_t{patch} + 1].w += float{shared::kCreased};
  }
}

}  // namespace weft::native
