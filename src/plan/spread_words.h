// What the host says in spread_state before a frame in which the cloth may stay spread out.
#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "model/model.h"
#include "passes/host_buffers.h"
#include "plan/spread_bound.h"

namespace weft {

/// Nothing is found yet; how far cells have to go, and by how much a velocity may change in a substep.
/// @param words   kSpreadStateWords
/// @param widest  of SpreadBound::kMargins, that looks ask for: wider ones cost time where the cloth bends
void begin_spread_words(std::vector<std::uint32_t>& words, const SpreadBound& bound, const Model& model,
                        double kick_most_m_s, std::uint32_t widest = 0);

/// The plane that is as near as can be to two directions, and the velocity that speeds are relative to.
void put_spread_plane(std::vector<std::uint32_t>& words, const glm::dvec3& along, const glm::dvec3& down,
                      const glm::dvec3& shared_m_s);

/// Words for checking the passes of such a frame on the state in `buffers`: the plane of its corners, and as
/// velocities before the latest substep nine tenths of those that there are.
template <class T>
void ask_for_spread(const Plan& plan, const Model& model, HostBuffers<T>& buffers);

}  // namespace weft
