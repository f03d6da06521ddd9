// How many bytes each buffer of the dictionary takes, and which buffers a pass touches.
#include "plan/buffers.h"

#include <array>
#include <bit>

#include "passes/coefficients.h"
#include "passes/collision.h"
#include "passes/mesh_grids.h"
#include "passes/passes.h"
#include "passes/patches.h"
#include "passes/reach.h"
#include "passes/tables.h"
#include "passes/tearing.h"
#include "passes/xpbd.h"
#include "plan/plan.h"
#include "shared/spread.h"

namespace weft {

std::uint32_t substep_row_capacity(std::uint32_t rows) { return std::bit_ceil(rows); }

std::uint32_t substep_row_stride(const Model& model) { return row_layout(model).stride; }

std::uint64_t element_count(BufferId id, const Model& model, std::uint32_t rows) {
  switch (id) {
    case BufferId::params: return 1;
    case BufferId::compensation: return 2 * std::uint64_t{model.grid.count()};
    case BufferId::constraints: return shared::kConstraintRows + constraint_shift(model);
    case BufferId::strain_limits: return shared::kLimitRows;
    case BufferId::substeps: return std::uint64_t{substep_row_capacity(rows)} * substep_row_stride(model);
    case BufferId::collision: return 1;
    case BufferId::moved_pins: return model.moved_particles.size();
    case BufferId::distance_grids: return distance_word_count(model);
    case BufferId::collision_state: return shared::kCollisionStateWords;
    case BufferId::cells: return collision_layout(model).buckets + std::uint64_t{1};
    case BufferId::pair_places: return std::uint64_t{collision_layout(model).capacity} * model.grid.count();
    case BufferId::surface_pairs:
      return std::uint64_t{collision_layout(model).surface_capacity} * model.grid.count();
    case BufferId::carrier: return shared::kCarrierRows;
    case BufferId::patches: return 2 * patch_domain(model).items();
    case BufferId::blocks: return 2 * block_domain(model).items();
    case BufferId::cell_arrivals:
    case BufferId::cell_members: return block_domain(model).items();
    case BufferId::patch_listed: return patch_domain(model).items();
    case BufferId::surface_sums: return std::uint64_t{shared::kSumPlanes} * model.grid.count();
    case BufferId::spread_state: return shared::kSpreadStateWords;
    case BufferId::watch_state: return shared::kWatchStateWords;
    case BufferId::watch_parts: return shared::kPartPlanes * watch.domain(model).items();
    case BufferId::reach_groups:
      return model.scene.tearing ? shared::kReachWordsTearing : shared::kReachWords;
    case BufferId::torn_mesh: return torn_mesh_words(model.grid);
    default:  // one element a particle
      return model.grid.count();
  }
}

std::uint64_t slot_bytes(BufferId id, const Model& model, std::uint32_t rows, bool in_double) {
  const BufferRow& row = row_of(id);
  return (in_double ? row.element_bytes_double : row.element_bytes) * element_count(id, model, rows);
}

bool host_written(BufferId id) {
  return id == BufferId::params || id == BufferId::substeps || id == BufferId::constraints;
}

std::uint32_t slot_count(BufferId id) { return host_written(id) ? kFrameSlots : 1; }

template <class T>
void size_buffers(const Plan& plan, const Model& model, HostBuffers<T>& buffers) {
  for (const PlanBuffer& buffer : plan.buffers) {
    if (holds_words(buffer.id))
      buffers.words_of(buffer.id).assign(element_count(buffer.id, model, plan.row_count()), 0);
    else if (holds_vectors(buffer.id) && slot_count(buffer.id) == 1)
      buffers[buffer.id].assign(element_count(buffer.id, model, plan.row_count()), glm::vec<4, T>(T(0)));
  }
  auto& state = buffers.words_of(BufferId::collision_state);
  if (!state.empty()) state = initial_collision_state(model);
  auto& reach = buffers.words_of(BufferId::reach_groups);
  if (!reach.empty()) reach = initial_reach_groups(model, plan.reaching.links);
}

template void size_buffers(const Plan&, const Model&, HostBuffers<float>&);
template void size_buffers(const Plan&, const Model&, HostBuffers<double>&);

}  // namespace weft
