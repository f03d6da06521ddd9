// tear: links that are too long break for good. Declaration and CPU mirror.
// Source: Terzopoulos and Fleischer 1988, Modeling inelastic deformation, section 5: fibres break at a
// strain.
#include "passes/passes.h"
#include "passes/reach.h"
#include "passes/strain_limit.h"
#include "passes/tearing.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!take_tear(buffers)) return;
  const Grid& grid = context.model.grid;
  const auto limits = strain_limit_rows<T>(context.model);
  const auto& x = std::as_const(buffers)[BufferId::position];
  auto& links = buffers.words_of(BufferId::broken_links);
  const auto too_long = [&](std::uint32_t a, std::uint32_t b, std::uint32_t row) {
    const Vec3<T> d = xyz(x[b]) - xyz(x[a]);
    return dot3(d, d) > limits[row].y;
  };
  parallel_rows(grid.ny, grid.nx, [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t p = begin * grid.nx; p < end * grid.nx; ++p) {
      const bool right = p % grid.nx + 1 < grid.nx, below = p / grid.nx + 1 < grid.ny;
      if (right && too_long(p, p + 1, shared::kLimitStructural)) links[p] |= shared::kLinkAlongI;
      if (below && too_long(p, p + grid.nx, shared::kLimitStructural)) links[p] |= shared::kLinkAlongJ;
      if (!right || !below) continue;
      if (too_long(p, p + grid.nx + 1, shared::kLimitShear)) links[p] |= shared::kLinkFalling;
      if (too_long(p + 1, p + grid.nx, shared::kLimitShear)) links[p] |= shared::kLinkRising;
    }
  });
  auto& groups = buffers.words_of(BufferId::reach_groups);
  if (!groups.empty()) tell_torn(grid, links, groups);
}

}  // namespace

const Pass tear{
    .name = "tear",
    .about = "breaks links that are longer than the cloth bears",
    .domain = torn_cloth,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .reach_word = [](std::uint32_t) { return shared::kReachTear; },
};

}  // namespace weft
