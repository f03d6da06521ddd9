// surface_contact: what touching triangles and edges give their particles, in whole quanta. Declaration and
// CPU mirror.
#include "passes/passes.h"
#include "passes/surface_response.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  if (!touching_somewhere(buffers)) return;
  const CollisionView<T> view(context.model);
  const SurfaceResponse<T> response(view, buffers);
  auto& sums = buffers.words_of(BufferId::surface_sums);
  const auto give = [&](std::size_t place, std::uint32_t units) { sums[place] += units; };
  for_each_surface_pair(view, buffers, [&](const SurfacePair<T>& pair) {
    if (pair.squared < view.surface_limit_squared) response.add(pair, give);
  });
}

}  // namespace

const Pass surface_contact =
    collision_pass("surface_contact", "self-collision: pushes near triangles and edges apart", mirror<float>,
                   mirror<double>, shared::kTouchGroups);

}  // namespace weft
