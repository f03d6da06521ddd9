// present: positions and normals rounded to float, as drawing reads them. Declaration and CPU mirror.
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  for (const auto& [from, to] : {std::pair{BufferId::position, BufferId::draw_position},
                                 std::pair{BufferId::normal, BufferId::draw_normal}}) {
    buffers[to].resize(context.model.grid.count());
    for (std::size_t p = 0; p < buffers[to].size(); ++p)
      buffers[to][p] = glm::vec<4, T>(glm::vec4(buffers[from][p]));
  }
}

}  // namespace

const Pass present{
    .name = "present",
    .about = "positions and normals in float, as they are drawn",
    .domain = whole_cloth,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
