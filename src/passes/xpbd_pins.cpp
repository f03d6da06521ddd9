// xpbd_pins: how far moving pins take what they hold within the substep. Declaration and CPU mirror.
#include "passes/moved_pins.h"
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const SubstepRow<T> row = substep_row<T>(context.model, context.row);
  for (const MovedParticle& held : context.model.moved_particles)
    if (const PinRow<T>& pin = row.pins[held.pin]; !pin.released)
      buffers[BufferId::position_next][held.particle] = glm::vec<4, T>(row.drift * pin.velocity, T(0));
}

}  // namespace

const Pass xpbd_pins{
    .name = "xpbd_pins",
    .about = "how far moving pins take what they hold",
    .domain = moved_pins_range,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
