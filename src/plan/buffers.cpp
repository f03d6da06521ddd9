// How many bytes each buffer of the dictionary takes, and which buffers a pass touches.
#include "plan/buffers.h"

#include <array>
#include <bit>

#include "passes/passes.h"

namespace weft {

std::uint32_t substep_row_capacity(std::uint32_t substeps) { return std::bit_ceil(substeps + 1); }

std::uint32_t substep_row_stride(const Model& model) {
  return shared::kRowHeadVec4s +
         shared::kRowSphereVec4s * static_cast<std::uint32_t>(model.scene.spheres.size());
}

std::uint64_t slot_bytes(BufferId id, const Model& model, std::uint32_t substeps) {
  const std::uint64_t element = row_of(id).element_bytes;
  switch (id) {
    case BufferId::params: return element;
    case BufferId::substeps: return element * substep_row_capacity(substeps) * substep_row_stride(model);
    default:  // one element a particle
      return element * model.grid.count();
  }
}

std::uint32_t slot_count(BufferId id) {
  return id == BufferId::params || id == BufferId::substeps ? kFrameSlots : 1;
}

std::span<const BufferId> buffers_of(const Pass& pass) {
  static constexpr std::array kIntegrate = {BufferId::params,   BufferId::substeps,
                                            BufferId::position, BufferId::position_next,
                                            BufferId::velocity, BufferId::velocity_next};
  static constexpr std::array kNormals = {BufferId::params, BufferId::position, BufferId::normal};
  if (&pass == &integrate) return kIntegrate;
  if (&pass == &normals) return kNormals;
  return {};
}

}  // namespace weft
