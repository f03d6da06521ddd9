// The model as the device sees it: the parameter block, the frame's substep table, and a state in buffers.
#pragma once
#include <span>
#include <vector>

#include "model/model.h"
#include "passes/host_buffers.h"
#include "passes/pass.h"

namespace weft {

/// Everything in it is computed in double and rounded once.
/// @param energy_share_s2_m2  of the frame (model/speed_budget.h)
/// @throws Error(Exit::usage) when the scene has more spheres than shared::kMaxSpheres
template <class T = float>
shared::ParamsOf<T> make_params(const Model& model, double energy_share_s2_m2 = 0.0);

/// The words of collision_state before the first substep: no lists are there yet.
std::vector<std::uint32_t> initial_collision_state(const Model& model);

/// Replaces `table` with the rows of one frame, in the layout that shared/params.h documents.
template <class T>
void fill_substep_rows(const Model& model, std::span<const KickDrift> rows,
                       std::vector<glm::vec<4, T>>& table);

/// Rounds a state into position (w = relative inverse mass) and velocity (w = 0), both resized to the grid.
/// Where `buffers` has room for the compensation, it takes what rounding adds to positions and
/// velocities; where it has links, they are the state's.
template <class T>
void load_state(const Model& model, const State& state, HostBuffers<T>& buffers);

/// The state in position, velocity and, where there is one, the compensation; exact, since double holds every
/// float.
template <class T>
State store_state(const HostBuffers<T>& buffers, double time_s);

}  // namespace weft
