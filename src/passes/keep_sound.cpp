// keep_sound: the last state that was sound. Declaration and CPU mirror.
#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext&, HostBuffers<T>& buffers) {
  if (buffers.words_of(BufferId::watch_state)[shared::kWatchStopped] != 0) return;
  buffers[BufferId::kept_position] = buffers[BufferId::position];
  buffers[BufferId::kept_velocity] = buffers[BufferId::velocity];
}

}  // namespace

const Pass keep_sound{
    .name = "keep_sound",
    .about = "divergence: keeps the state while it is sound",
    .domain = whole_cloth,
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
