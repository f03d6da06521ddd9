// How many bytes each buffer of the dictionary takes, and which buffers a pass touches.
#include "plan/buffers.h"

#include <array>
#include <bit>

#include "passes/passes.h"

namespace weft {

std::uint32_t substep_row_capacity(std::uint32_t rows) { return std::bit_ceil(rows); }

std::uint32_t substep_row_stride(const Model& model) {
  return shared::kRowHeadVec4s +
         shared::kRowSphereVec4s * static_cast<std::uint32_t>(model.scene.spheres.size());
}

std::uint64_t slot_bytes(BufferId id, const Model& model, std::uint32_t rows) {
  const std::uint64_t element = row_of(id).element_bytes;
  switch (id) {
    case BufferId::params: return element;
    case BufferId::compensation: return 2 * element * model.grid.count();
    case BufferId::constraints: return element * shared::kConstraintRows;
    case BufferId::substeps: return element * substep_row_capacity(rows) * substep_row_stride(model);
    default:  // one element a particle
      return element * model.grid.count();
  }
}

bool host_written(BufferId id) {
  return id == BufferId::params || id == BufferId::substeps || id == BufferId::constraints;
}

std::uint32_t slot_count(BufferId id) { return host_written(id) ? kFrameSlots : 1; }

std::span<const BufferId> buffers_of(const Pass& pass) {
  static constexpr std::array kIntegrate = {BufferId::params,   BufferId::substeps,
                                            BufferId::position, BufferId::position_next,
                                            BufferId::velocity, BufferId::velocity_next};
  static constexpr std::array kNormals = {BufferId::params, BufferId::position, BufferId::normal};
  static constexpr std::array kVelocityVerlet = {
      BufferId::params,   BufferId::substeps,      BufferId::position,     BufferId::position_next,
      BufferId::velocity, BufferId::velocity_next, BufferId::half_velocity};
  static constexpr std::array kVerlet = {
      BufferId::params,   BufferId::substeps,      BufferId::position,         BufferId::position_next,
      BufferId::velocity, BufferId::velocity_next, BufferId::position_previous};
  if (&pass == &integrate || &pass == &euler_step) return kIntegrate;
  if (&pass == &velocity_verlet_step) return kVelocityVerlet;
  if (&pass == &verlet_step) return kVerlet;
  static constexpr std::array kIntegrateCompensated = {
      BufferId::params,   BufferId::substeps,      BufferId::position,    BufferId::position_next,
      BufferId::velocity, BufferId::velocity_next, BufferId::compensation};
  static constexpr std::array kVelocityVerletCompensated = {
      BufferId::params,   BufferId::substeps,      BufferId::position,      BufferId::position_next,
      BufferId::velocity, BufferId::velocity_next, BufferId::half_velocity, BufferId::compensation};
  if (&pass == &integrate_compensated) return kIntegrateCompensated;
  if (&pass == &velocity_verlet_compensated) return kVelocityVerletCompensated;
  static constexpr std::array kRungeKutta = {
      BufferId::params,       BufferId::substeps,      BufferId::position,      BufferId::position_next,
      BufferId::velocity,     BufferId::velocity_next, BufferId::base_position, BufferId::base_velocity,
      BufferId::sum_position, BufferId::sum_velocity};
  if (&pass == &trapezoid_predict || &pass == &trapezoid_correct) return kIntegrate;
  if (&pass == &rk4_first || &pass == &rk4_middle || &pass == &rk4_last) return kRungeKutta;
  static constexpr std::array kXpbdPredict = {BufferId::params, BufferId::substeps, BufferId::position,
                                              BufferId::position_next, BufferId::velocity};
  static constexpr std::array kXpbdSpring = {BufferId::params, BufferId::substeps, BufferId::position,
                                             BufferId::position_next, BufferId::constraints};
  static constexpr std::array kXpbdFinish = {BufferId::params,   BufferId::substeps,
                                             BufferId::position, BufferId::position_next,
                                             BufferId::velocity, BufferId::velocity_next};
  if (&pass == &xpbd_predict) return kXpbdPredict;
  if (&pass == &xpbd_spring || &pass == &xpbd_bend) return kXpbdSpring;
  if (&pass == &xpbd_finish) return kXpbdFinish;
  if (&pass == &normals) return kNormals;
  return {};
}

}  // namespace weft
