// judge: whether the state is sound, from what watch found. Declaration and CPU mirror.
#include <algorithm>

#include "passes/passes.h"

namespace weft {
namespace {

template <class T>
void mirror(const MirrorContext&, HostBuffers<T>& buffers) {
  const auto& words = buffers.words_of(BufferId::watch_parts);
  auto& state = buffers.words_of(BufferId::watch_state);
  if (state[shared::kWatchStopped] != 0) return;
  const std::size_t parts = words.size() / shared::kPartPlanes;
  std::uint32_t fastest = 0, particle = 0xffffffffu;
  std::uint64_t energy = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::uint32_t speed = words[shared::kPartFastest * parts + part],
                        who = words[shared::kPartParticle * parts + part];
    if (speed > fastest || (speed == fastest && who < particle)) particle = who;
    fastest = std::max(fastest, speed);
    energy += words[shared::kPartEnergy * parts + part];
  }
  state[shared::kWatchFastest] = fastest;
  state[shared::kWatchParticle] = particle;
  state[shared::kWatchEnergy] =
      static_cast<std::uint32_t>(std::min(energy, std::uint64_t{shared::kWatchMost}));
  if (fastest >= shared::kWatchInfinite || state[shared::kWatchEnergy] > shared::kWatchWhole)
    state[shared::kWatchStopped] = 1;
  else
    ++state[shared::kWatchSound];
}

}  // namespace

const Pass judge{
    .name = "judge",
    .about = "divergence: is the state still sound?",
    .domain = [](const Model&) { return Range{.x = 1, .y = 1}; },
    .mirror_f32 = mirror<float>,
    .mirror_f64 = mirror<double>,
};

}  // namespace weft
