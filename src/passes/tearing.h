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

/// The broken links a pass has to ask, empty (nothing is broken) where nothing tears.
template <bool kTorn, class T>
std::span<const std::uint32_t> links_of(const HostBuffers<T>& buffers) {
  if constexpr (kTorn) return buffers.words_of(BufferId::broken_links);
  return {};
}

}  // namespace weft
