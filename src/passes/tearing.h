// What the passes of tearing share: the links' table on the host, and how long the index list is.
#pragma once
#include "model/links.h"
#include "passes/substep.h"

namespace weft {

/// Six indices a cell for its triangles, then six a particle for its lines.
inline std::uint64_t torn_mesh_words(const Grid& grid) {
  return 6 * (std::uint64_t{grid.nx - 1} * (grid.ny - 1) + grid.count());
}

inline Range torn_cloth(const Model& m) { return m.scene.tearing ? whole_cloth(m) : Range{}; }

}  // namespace weft
