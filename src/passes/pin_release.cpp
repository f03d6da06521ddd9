// pin_release: what a pin lets go of gets its mass back. Declaration and CPU mirror.
#include "passes/moved_pins.h"
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

Range domain(const Model& model) {
  return model.released_inverse_mass.empty() ? Range{} : moved_pins_range(model);
}

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const SubstepRow<T> row = substep_row<T>(context.model, context.row);
  for (const MovedParticle& held : context.model.moved_particles) {
    auto& x = buffers[BufferId::position][held.particle];
    if (row.pins[held.pin].released && x.w == T(0))
      x.w = static_cast<T>(context.model.loosest_inverse_mass(held.particle));
  }
}

}  // namespace

const Pass pin_release{
    .name = "pin_release",
    .about = "gives particles their mass back once their pin has let go",
    .domain = domain,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
