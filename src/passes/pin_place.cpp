// pin_place: the particles of pins that move are put where these are. Declaration and CPU mirror.
#include "passes/moved_pins.h"
#include "passes/passes.h"
#include "passes/substep.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext& context, HostBuffers<T>& buffers) {
  const SubstepRow<T> row = substep_row<T>(context.model, context.row);
  for (const MovedParticle& held : context.model.moved_particles) {
    const PinRow<T>& pin = row.pins[held.pin];
    if (pin.released) continue;
    const Vec3<T> anchor(held.anchor_m);
    buffers[BufferId::position][held.particle] = glm::vec<4, T>(anchor + pin.offset, T(0));
    buffers[BufferId::velocity][held.particle] = glm::vec<4, T>(pin.velocity, T(0));
  }
}

}  // namespace

const Pass pin_place{
    .name = "pin_place",
    .about = "puts what moving pins hold where these are by now",
    .domain = moved_pins_range,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
