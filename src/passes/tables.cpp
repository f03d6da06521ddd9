// Fills the parameter block, the substep table and the state buffers.
#include "passes/tables.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "model/distance_grid.h"
#include "passes/coefficients.h"
#include "passes/patches.h"
#include "passes/reach.h"

namespace weft {

template <class T>
shared::ParamsOf<T> make_params(const Model& model, double energy_share_s2_m2) {
  const Scene& scene = model.scene;
  if (scene.spheres.size() > shared::kMaxSpheres)
    throw error(Exit::usage, "{}: there are {} [[spheres]]; at most {} are possible (remove some)",
                place_of(scene, fmt::format("spheres.{}", shared::kMaxSpheres)), scene.spheres.size(),
                shared::kMaxSpheres);
  const SpringRows<T> springs = spring_rows<T>(model);
  shared::ParamsOf<T> params{};
  for (std::size_t r = 0; r < springs.structural.size(); ++r) params.structural[r] = springs.structural[r];
  for (std::size_t r = 0; r < springs.flex.size(); ++r) params.flex[r] = springs.flex[r];
  params.shear = springs.shear;
  if (scene.gravity) params.gravity_m_s2 = scene.gravity->acceleration_m_s2;
  params.inverse_mass_1_kg = static_cast<T>(1.0 / model.interior_mass_kg);
  if (scene.floor) {
    params.floor_height_m = static_cast<T>(scene.floor->height_m + model.half_thickness_m);
    params.floor_friction = static_cast<T>(scene.floor->friction);
  }
  params.nx = model.grid.nx;
  params.ny = model.grid.rows();
  params.sphere_count = static_cast<shared::uint>(scene.spheres.size());
  params.energy_share_s2_m2 = static_cast<T>(energy_share_s2_m2);
  params.row_stride = row_layout(model).stride;
  return params;
}

std::vector<std::uint32_t> initial_collision_state(const Model& model) {
  std::vector<std::uint32_t> state(shared::kCollisionStateWords, 0);
  const auto rows_of_groups = [&](std::uint32_t word, std::uint32_t rows) {
    state[word + 1] = rows;
    state[word + 2] = 1;
  };
  rows_of_groups(shared::kListGroups, patch_domain(model).y);
  rows_of_groups(shared::kBlockGroups, block_domain(model).y);
  for (const std::uint32_t word : {shared::kScanGroups, shared::kNearGroups}) rows_of_groups(word, 1);
  for (const std::uint32_t word : {shared::kContactGroups, shared::kTouchGroups})
    rows_of_groups(word, model.grid.rows());
  state[shared::kSmallestGap] = shared::kInfinity;
  return state;
}

namespace {

template <class T>
void append_solid(const SolidRow<T>& solid, std::vector<glm::vec<4, T>>& table) {
  table.emplace_back(solid.center, solid.reach);
  table.emplace_back(solid.start, solid.friction);
  table.emplace_back(solid.velocity, solid.deep);
  table.emplace_back(solid.spin, T(0));
  for (int k = 0; k < 3; ++k) table.emplace_back(solid.axes[k], solid.half[k]);
  for (int k = 0; k < 3; ++k) table.emplace_back(solid.start_axes[k], T(0));
}

/// The grid's corner, cell and samples.
template <class T>
void append_grid(const DistanceGrid& grid, std::size_t first, std::vector<glm::vec<4, T>>& table) {
  table.emplace_back(glm::vec<3, T>(grid.low_m), static_cast<T>(grid.cell_m));
  table.emplace_back(glm::vec<3, T>(grid.samples), static_cast<T>(first));
}

template <class T>
void append_air(const AirRow<T>& air, std::vector<glm::vec<4, T>>& table) {
  table.emplace_back(air.wind, air.slice_share);
  table.emplace_back(air.origin, air.cells_1_m);
  table.emplace_back(air.slice, air.noise_m_s, air.drag, air.lift);
}

}  // namespace

template <class T>
void fill_substep_rows(const Model& model, std::span<const KickDrift> rows,
                       std::vector<glm::vec<4, T>>& table) {
  table.clear();
  for (const KickDrift& kick_drift : rows) {
    const SubstepRow<T> row = substep_row<T>(model, kick_drift);
    table.emplace_back(row.alpha_wind, row.loss);
    table.emplace_back(row.gain, row.drift, row.predict_gain, row.predict_loss);
    for (const SphereRow<T>& sphere : row.spheres) {
      table.emplace_back(sphere.center, sphere.reach);
      table.emplace_back(sphere.travel, sphere.friction);
      table.emplace_back(sphere.velocity, T(0));
    }
    for (const PinRow<T>& pin : row.pins) {
      table.emplace_back(pin.offset, pin.released ? T(1) : T(0));
      table.emplace_back(pin.velocity, T(0));
    }
    for (const SolidRow<T>& solid : row.solids) append_solid(solid, table);
    std::size_t first = 0;
    for (std::size_t mesh = 0; mesh < row.meshes.size(); ++mesh) {
      append_solid(row.meshes[mesh], table);
      append_grid(*model.meshes[mesh], first, table);
      first += model.meshes[mesh]->distance.size();
    }
    if (model.scene.aerodynamics) append_air(air_row<T>(model, kick_drift), table);
    if (has_tilted_floor(model)) {
      const TiltRow<double> tilt = tilt_row_exact(model);
      table.emplace_back(glm::vec<3, T>(tilt.normal), static_cast<T>(tilt.level));
    }
    if (!has_reach(model)) continue;
    const ReachRow<T> reach = reach_row<T>(model, kick_drift);
    table.emplace_back(reach.low, reach.leap);
    table.emplace_back(reach.high, T(0));
    table.emplace_back(reach.link2, reach.diagonal2, reach.step2, T(0));
  }
}

template <class T>
void load_state(const Model& model, const State& state, HostBuffers<T>& buffers) {
  const std::size_t count = model.grid.count();
  WEFT_ASSERT(state.position.size() == count && state.velocity.size() == count);
  auto& position = buffers[BufferId::position];
  auto& velocity = buffers[BufferId::velocity];
  position.resize(count);
  velocity.resize(count);
  for (std::size_t p = 0; p < count; ++p) {
    position[p] = glm::vec<4, T>(glm::vec<3, T>(state.position[p]),
                                 T(model.inverse_mass_at(static_cast<std::uint32_t>(p), state.time_s)));
    velocity[p] = glm::vec<4, T>(glm::vec<3, T>(state.velocity[p]), T(0));
  }
  auto& links = buffers.words_of(BufferId::broken_links);
  if (!links.empty()) {
    links.assign(count, 0);
    std::ranges::copy(state.broken_links, links.begin());
    auto& groups = buffers.words_of(BufferId::reach_groups);
    if (!groups.empty()) tell_torn(model.grid, links, groups);
  }
  auto& excess = buffers[BufferId::compensation];
  if (excess.empty()) return;
  const auto too_much = [](const glm::vec<4, T>& held, const glm::dvec3& meant) {
    return glm::vec<4, T>(glm::vec<3, T>(glm::dvec3(held.x, held.y, held.z) - meant), T(0));
  };
  excess.resize(2 * count);
  for (std::size_t p = 0; p < count; ++p) {
    excess[p] = too_much(position[p], state.position[p]);
    excess[count + p] = too_much(velocity[p], state.velocity[p]);
  }
  // pin_place writes places anew, and nothing sums there.
  for (const MovedParticle& held : model.moved_particles)
    if (position[held.particle].w == T(0))
      excess[held.particle] = excess[count + held.particle] = glm::vec<4, T>(T(0));
}

template <class T>
State store_state(const HostBuffers<T>& buffers, double time_s) {
  const auto& position = buffers[BufferId::position];
  const auto& velocity = buffers[BufferId::velocity];
  State state;
  state.time_s = time_s;
  state.broken_links = buffers.words_of(BufferId::broken_links);
  state.position.reserve(position.size());
  state.velocity.reserve(velocity.size());
  for (const auto& x : position) state.position.emplace_back(x.x, x.y, x.z);
  for (const auto& v : velocity) state.velocity.emplace_back(v.x, v.y, v.z);
  const auto& excess = buffers[BufferId::compensation];
  for (std::size_t p = 0; p < excess.size() / 2; ++p) {
    const auto &x = excess[p], &v = excess[excess.size() / 2 + p];
    state.position[p] -= glm::dvec3(x.x, x.y, x.z);
    state.velocity[p] -= glm::dvec3(v.x, v.y, v.z);
  }
  return state;
}

template shared::ParamsOf<float> make_params(const Model&, double);
template shared::ParamsOf<double> make_params(const Model&, double);
template void fill_substep_rows(const Model&, std::span<const KickDrift>, std::vector<glm::vec<4, float>>&);
template void fill_substep_rows(const Model&, std::span<const KickDrift>, std::vector<glm::vec<4, double>>&);
template void load_state(const Model&, const State&, HostBuffers<float>&);
template void load_state(const Model&, const State&, HostBuffers<double>&);
template State store_state(const HostBuffers<float>&, double);
template State store_state(const HostBuffers<double>&, double);

}  // namespace weft
