#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Second of the three: adds up what `watch` found and says whether the simulation is still sound. Once it is
// not, the words stay as they are, so that the first frame that went wrong is the one that is reported.
// One workgroup: each invocation takes every 256th part, then half of them take in the other half, and so on.
// Source: docs/physics.md "Divergence".

#include "../shared/watch.h"
READS  (uint, watch_parts)
UPDATES(uint, watch_state)

layout(local_size_x = 256) in;

struct Found {
  uint fastest, particle, energy;
};
shared Found found[gl_WorkGroupSize.x];

Found both(Found a, Found b) {
  bool second = b.fastest > a.fastest || (b.fastest == a.fastest && b.particle < a.particle);
  return Found(second ? b.fastest : a.fastest, second ? b.particle : a.particle,
               min(a.energy + b.energy, kWatchMost));
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  uint parts = params.nx * ((params.ny + kWatchRows - 1u) / kWatchRows);
  Found mine = Found(0u, 0xffffffffu, 0u);
  for (uint part = lane; part < parts; part += gl_WorkGroupSize.x)
    mine =
        both(mine, Found(watch_parts[kPartFastest * parts + part], watch_parts[kPartParticle * parts + part],
                         watch_parts[kPartEnergy * parts + part]));
  found[lane] = mine;
  for (uint half_count = gl_WorkGroupSize.x / 2u; half_count > 0u; half_count /= 2u) {
    barrier();
    if (lane < half_count) found[lane] = both(found[lane], found[lane + half_count]);
  }
  if (lane != 0u || watch_state[kWatchStopped] != 0u) return;
  mine = found[0];
  watch_state[kWatchFastest] = mine.fastest;
  watch_state[kWatchParticle] = mine.particle;
  watch_state[kWatchEnergy] = mine.energy;
  if (mine.fastest >= kWatchInfinite || mine.energy > kWatchWhole)
    watch_state[kWatchStopped] = 1u;
  else
    watch_state[kWatchSound] += 1u;
}
