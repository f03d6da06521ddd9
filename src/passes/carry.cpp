// carry: the motion that all of the cloth shares. Declaration and CPU mirror.
#include "passes/carry.h"

#include <utility>

#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const auto &position = std::as_const(buffers)[BufferId::position],
             &velocity = std::as_const(buffers)[BufferId::velocity];
  carry_along(
      context.model, shares_motion(context.model), buffers,
      [&](std::uint32_t p) { return glm::vec<3, T>(position[p]); },
      [&](std::uint32_t p) { return glm::vec<3, T>(velocity[p]); });
}

/// One workgroup.
Range domain(const Model& model) { return model.scene.self_collision ? Range{.x = 1, .y = 1} : Range{}; }

}  // namespace

const Pass carry{
    .name = "carry",
    .about = "self-collision: the motion that all of the cloth shares",
    .domain = domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
    .interval = contact_interval,
};

}  // namespace weft
