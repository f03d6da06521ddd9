// torn_mesh: which triangles and lines of a torn cloth are drawn, as an index list. Declaration and CPU
// mirror.
#include "passes/passes.h"
#include "passes/tearing.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const Grid& grid = context.model.grid;
  const auto& links = buffers.words_of(BufferId::broken_links);
  auto& mesh = buffers.words_of(BufferId::torn_mesh);
  std::size_t next = 0;
  const auto put = [&](bool whole, std::initializer_list<std::uint32_t> corners) {
    for (const std::uint32_t corner : corners) mesh[next++] = whole ? corner : *corners.begin();
  };
  for (std::uint32_t j = 0; j + 1 < grid.ny; ++j)
    for (std::uint32_t i = 0; i + 1 < grid.nx; ++i) {
      const std::uint32_t own = grid.index(i, j), below = own + grid.nx;
      put(is_whole_a(links, own), {own, below, own + 1});
      put(is_whole_b(links, grid, own), {own + 1, below, below + 1});
    }
  const auto put_links = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t p = grid.index(i, j);
    const bool right = i + 1 < grid.nx, below = j + 1 < grid.ny;
    put(right && !is_broken(links, p, shared::kLinkAlongI), {p, p + 1});
    put(below && !is_broken(links, p, shared::kLinkAlongJ), {p, p + grid.nx});
    if (right && below && !is_broken(links, p, shared::kLinkRising))
      put(true, {p + 1, p + grid.nx});
    else
      put(false, {p, p});
  };
  for (std::uint32_t j = 0; j < grid.ny; ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i) put_links(i, j);
}

}  // namespace

const Pass torn_mesh{
    .name = "torn_mesh",
    .about = "the triangles and lines that are whole, as they are drawn",
    .domain = torn_cloth,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
