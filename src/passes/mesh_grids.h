// The distances of a scene's meshes as mesh_contact reads them.
#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace weft {

/// The buffer distance_grids: the bits of every sample, grid by grid.
std::vector<std::uint32_t> make_distance_words(const Model& model);
std::uint64_t distance_word_count(const Model& model);

}  // namespace weft
