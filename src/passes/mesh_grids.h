// The distances of a scene's meshes as mesh_contact reads them, and its contact by particle.
#pragma once
#include <cstdint>
#include <vector>

#include "model/distance_grid.h"
#include "model/model.h"
#include "passes/coefficients.h"

namespace weft {

/// The buffer distance_grids: the bits of every sample, grid by grid.
std::vector<std::uint32_t> make_distance_words(const Model& model);
std::uint64_t distance_word_count(const Model& model);

/// mesh_contact's mirror for one particle and one mesh: a drift from x0 to x1, and the velocity after it.
void touch_mesh(const DistanceGrid& grid, const SolidRow<float>& row, const glm::vec3& x0, glm::vec3& x1,
                glm::vec3& v);

}  // namespace weft
