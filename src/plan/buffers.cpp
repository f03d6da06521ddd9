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

namespace {

std::span<const BufferId> collision_buffers_of(const Pass& pass) {
  using enum BufferId;
  static constexpr std::array kCarry = {params,         position,      velocity, collision,
                                        built_position, near_position, carrier};
  static constexpr std::array kPairCheck = {params,          position,       velocity, collision,
                                            collision_state, built_position, cells,    near_position,
                                            surface_bound,   carrier};
  static constexpr std::array kCellCount = {params,         position, collision,  collision_state,
                                            built_position, cells,    pair_count, surface_count,
                                            surface_bound,  patches,  blocks};
  static constexpr std::array kCellScan = {collision, collision_state, cells};
  static constexpr std::array kCellFill = {params, collision, collision_state, cells, cell_arrivals, blocks};
  static constexpr std::array kCellSort = {params,        collision,    collision_state, cells,
                                           cell_arrivals, cell_members, blocks};
  static constexpr std::array kPatchNear = {params,  collision,    collision_state, cells, cell_members,
                                            patches, patch_listed, lookers,         blocks};
  static constexpr std::array kPairGather = {params,  position,     collision,  collision_state,
                                             cells,   cell_members, pair_count, pair_places,
                                             patches, patch_listed, lookers,    blocks};
  static constexpr std::array kSurfaceGather = {params,  position,     collision,     collision_state,
                                                cells,   cell_members, surface_count, surface_pairs,
                                                patches, patch_listed, lookers,       blocks};
  static constexpr std::array kTouchCount = {params,          position,      velocity,      collision,
                                             collision_state, pair_count,    pair_places,   touch_weight,
                                             near_position,   near_velocity, surface_bound, surface_sums};
  static constexpr std::array kSurfaceTouch = {params,        collision,     collision_state, touch_weight,
                                               near_position, surface_count, surface_pairs,   surface_bound};
  static constexpr std::array kSurfaceContact = {params,        collision,     touch_weight,  near_position,
                                                 near_velocity, surface_count, surface_pairs, surface_sums};
  static constexpr std::array kSelfContact = {params,        velocity,    collision,    collision_state,
                                              pair_count,    pair_places, touch_weight, near_position,
                                              near_velocity, surface_sums};
  if (&pass == &carry) return kCarry;
  if (&pass == &pair_check) return kPairCheck;
  if (&pass == &patch_near) return kPatchNear;
  if (&pass == &cell_count) return kCellCount;
  if (&pass == &cell_scan) return kCellScan;
  if (&pass == &cell_fill) return kCellFill;
  if (&pass == &cell_sort) return kCellSort;
  if (&pass == &pair_gather) return kPairGather;
  if (&pass == &surface_gather) return kSurfaceGather;
  if (&pass == &weft::touch_weight) return kTouchCount;
  if (&pass == &surface_touch) return kSurfaceTouch;
  if (&pass == &surface_contact) return kSurfaceContact;
  if (&pass == &self_contact) return kSelfContact;
  return {};
}

}  // namespace

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
  static constexpr std::array kXpbdTethers = {BufferId::params, BufferId::position, BufferId::position_next,
                                              BufferId::tethers};
  if (&pass == &xpbd_tethers) return kXpbdTethers;
  static constexpr std::array kPresent = {BufferId::params, BufferId::position, BufferId::normal,
                                          BufferId::draw_position, BufferId::draw_normal};
  if (&pass == &present) return kPresent;
  using enum BufferId;
  static constexpr std::array kPinPlace = {params, substeps, position, velocity, moved_pins};
  static constexpr std::array kSolidContact = {params, substeps, position, position_next, velocity};
  static constexpr std::array kAerodynamics = {params,        substeps, position,
                                               position_next, velocity, velocity_next};
  static constexpr std::array kAerodynamicsTorn = {params,   substeps,      position,    position_next,
                                                   velocity, velocity_next, broken_links};
  if (&pass == &weft::aerodynamics) return kAerodynamics;
  if (&pass == &aerodynamics_torn) return kAerodynamicsTorn;
  if (&pass == &solid_contact) return kSolidContact;
  static constexpr std::array kMeshContact = {params,        substeps, position,
                                              position_next, velocity, distance_grids};
  if (&pass == &mesh_contact) return kMeshContact;
  static constexpr std::array kXpbdPins = {params, substeps, position_next, moved_pins};
  static constexpr std::array kPinRelease = {params, substeps, position, moved_pins};
  if (&pass == &pin_release) return kPinRelease;
  if (&pass == &pin_place) return kPinPlace;
  static constexpr std::array kTear = {params, position, strain_limits, broken_links, reach_groups};
  static constexpr std::array kIntegrateTorn = {params,   substeps,      position,     position_next,
                                                velocity, velocity_next, broken_links, reach_groups};
  static constexpr std::array kNormalsTorn = {params, position, normal, broken_links};
  static constexpr std::array kTornMesh = {params, broken_links, BufferId::torn_mesh};
  if (&pass == &tear) return kTear;
  static constexpr std::array kIntegrateTornCompensated = {params,        substeps,     position,
                                                           position_next, velocity,     velocity_next,
                                                           broken_links,  reach_groups, compensation};
  if (&pass == &integrate_torn) return kIntegrateTorn;
  if (&pass == &integrate_torn_compensated) return kIntegrateTornCompensated;
  if (&pass == &normals_torn) return kNormalsTorn;
  if (&pass == &weft::torn_mesh) return kTornMesh;
  if (&pass == &xpbd_pins) return kXpbdPins;
  static constexpr std::array kStrainLimit = {params, substeps, position, velocity, strain_limits};
  if (&pass == &strain_limit) return kStrainLimit;
  static constexpr std::array kWatch = {params, position, velocity, watch_parts};
  static constexpr std::array kJudge = {params, watch_parts, watch_state};
  static constexpr std::array kKeep = {params, position, velocity, watch_state, kept_position, kept_velocity};
  if (&pass == &normals) return kNormals;
  if (&pass == &watch) return kWatch;
  if (&pass == &judge) return kJudge;
  if (&pass == &keep_sound) return kKeep;
  return collision_buffers_of(pass);
}

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
