// Which buffers each pass reads or writes: one row a pass. A test holds the rows to the shaders' SPIR-V.
#include <algorithm>
#include <array>

#include "passes/passes.h"
#include "passes/tearing.h"
#include "passes/xpbd.h"
#include "plan/buffers.h"

namespace weft {
namespace {

using Id = BufferId;

template <BufferId... kIds>
constexpr std::array<BufferId, sizeof...(kIds)> kThese{kIds...};

struct PassBuffers {
  const Pass* pass;
  std::span<const BufferId> buffers;
};

constexpr PassBuffers kPassBuffers[] = {
    // Solvers.
    {&weft::integrate,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next>},
    {&weft::euler_step,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next>},
    {&weft::integrate_compensated, kThese<Id::params, Id::substeps, Id::position, Id::position_next,
                                          Id::velocity, Id::velocity_next, Id::compensation>},
    {&weft::velocity_verlet_step, kThese<Id::params, Id::substeps, Id::position, Id::position_next,
                                         Id::velocity, Id::velocity_next, Id::half_velocity>},
    {&weft::velocity_verlet_compensated,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next,
            Id::half_velocity, Id::compensation>},
    {&weft::verlet_step, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity,
                                Id::velocity_next, Id::position_previous>},
    {&weft::trapezoid_predict,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next>},
    {&weft::trapezoid_correct,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next>},
    {&weft::rk4_first,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next,
            Id::base_position, Id::base_velocity, Id::sum_position, Id::sum_velocity>},
    {&weft::rk4_middle,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next,
            Id::base_position, Id::base_velocity, Id::sum_position, Id::sum_velocity>},
    {&weft::rk4_last,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next,
            Id::base_position, Id::base_velocity, Id::sum_position, Id::sum_velocity>},
    {&weft::xpbd_predict, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity>},
    {&weft::xpbd_pins, kThese<Id::params, Id::substeps, Id::position_next, Id::moved_pins>},
    {&weft::xpbd_spring, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::constraints>},
    {&weft::xpbd_bend, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::constraints>},
    {&weft::xpbd_tethers, kThese<Id::params, Id::position, Id::position_next, Id::tethers>},
    {&weft::xpbd_finish,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next>},
    // What acts beside the springs.
    {&weft::pin_place, kThese<Id::params, Id::substeps, Id::position, Id::velocity, Id::moved_pins>},
    {&weft::pin_release, kThese<Id::params, Id::substeps, Id::position, Id::moved_pins>},
    {&weft::aerodynamics,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next>},
    {&weft::solid_contact, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity>},
    {&weft::mesh_contact,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::distance_grids>},
    {&weft::strain_limit, kThese<Id::params, Id::substeps, Id::position, Id::velocity, Id::strain_limits>},
    // Tearing.
    {&weft::tear, kThese<Id::params, Id::position, Id::strain_limits, Id::broken_links, Id::reach_groups>},
    {&weft::integrate_torn, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity,
                                   Id::velocity_next, Id::broken_links, Id::reach_groups>},
    {&weft::integrate_torn_compensated,
     kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity, Id::velocity_next,
            Id::broken_links, Id::reach_groups, Id::compensation>},
    {&weft::aerodynamics_torn, kThese<Id::params, Id::substeps, Id::position, Id::position_next, Id::velocity,
                                      Id::velocity_next, Id::broken_links>},
    {&weft::normals_torn, kThese<Id::params, Id::position, Id::normal, Id::broken_links>},
    {&weft::torn_mesh, kThese<Id::params, Id::broken_links, Id::torn_mesh>},
    // Self-collision.
    {&weft::carry, kThese<Id::params, Id::position, Id::velocity, Id::collision, Id::built_position,
                          Id::near_position, Id::carrier>},
    {&weft::pair_check,
     kThese<Id::params, Id::position, Id::velocity, Id::collision, Id::collision_state, Id::built_position,
            Id::cells, Id::near_position, Id::surface_bound, Id::carrier>},
    {&weft::cell_count,
     kThese<Id::params, Id::position, Id::collision, Id::collision_state, Id::built_position, Id::cells,
            Id::pair_count, Id::surface_count, Id::surface_bound, Id::patches, Id::blocks>},
    {&weft::cell_scan, kThese<Id::collision, Id::collision_state, Id::cells>},
    {&weft::cell_fill,
     kThese<Id::params, Id::collision, Id::collision_state, Id::cells, Id::cell_arrivals, Id::blocks>},
    {&weft::cell_sort, kThese<Id::params, Id::collision, Id::collision_state, Id::cells, Id::cell_arrivals,
                              Id::cell_members, Id::blocks>},
    {&weft::patch_near, kThese<Id::params, Id::collision, Id::collision_state, Id::cells, Id::cell_members,
                               Id::patches, Id::patch_listed, Id::lookers, Id::blocks>},
    {&weft::pair_gather,
     kThese<Id::params, Id::position, Id::collision, Id::collision_state, Id::cells, Id::cell_members,
            Id::pair_count, Id::pair_places, Id::patches, Id::patch_listed, Id::lookers, Id::blocks>},
    {&weft::surface_gather,
     kThese<Id::params, Id::position, Id::collision, Id::collision_state, Id::cells, Id::cell_members,
            Id::surface_count, Id::surface_pairs, Id::patches, Id::patch_listed, Id::lookers, Id::blocks>},
    {&weft::touch_weight, kThese<Id::params, Id::position, Id::velocity, Id::collision, Id::collision_state,
                                 Id::pair_count, Id::pair_places, Id::touch_weight, Id::near_position,
                                 Id::near_velocity, Id::surface_bound, Id::surface_sums>},
    {&weft::surface_touch,
     kThese<Id::params, Id::collision, Id::collision_state, Id::touch_weight, Id::near_position,
            Id::surface_count, Id::surface_pairs, Id::surface_bound>},
    {&weft::surface_contact,
     kThese<Id::params, Id::collision, Id::touch_weight, Id::near_position, Id::near_velocity,
            Id::surface_count, Id::surface_pairs, Id::surface_sums>},
    {&weft::self_contact,
     kThese<Id::params, Id::velocity, Id::collision, Id::collision_state, Id::pair_count, Id::pair_places,
            Id::touch_weight, Id::near_position, Id::near_velocity, Id::surface_sums>},
    {&weft::spread_look, kThese<Id::params, Id::position, Id::velocity, Id::velocity_next, Id::spread_state>},
    // A frame's end.
    {&weft::normals, kThese<Id::params, Id::position, Id::normal>},
    {&weft::present, kThese<Id::params, Id::position, Id::normal, Id::draw_position, Id::draw_normal>},
    {&weft::watch, kThese<Id::params, Id::position, Id::velocity, Id::watch_parts>},
    {&weft::judge, kThese<Id::params, Id::watch_parts, Id::watch_state>},
    {&weft::keep_sound,
     kThese<Id::params, Id::position, Id::velocity, Id::watch_state, Id::kept_position, Id::kept_velocity>},
};

}  // namespace

std::span<const BufferId> buffers_of(const Pass& pass) {
  const auto row = std::ranges::find(kPassBuffers, &pass, &PassBuffers::pass);
  return row == std::end(kPassBuffers) ? std::span<const BufferId>() : row->buffers;
}

}  // namespace weft
