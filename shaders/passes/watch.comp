#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// First of three passes that look for divergence at the frame's end: of each piece of a column, the fastest
// particle and the kinetic energy, as shares of what the scene can have given. Integers only: their sums and
// maxima do not depend on any order. Each invocation writes its own three words.
// Numbers are asked by their bits whether they are finite: a compiler may assume that comparisons see no NaN.
// Source: docs/physics.md "Divergence".

#include "../shared/watch.h"
READS (real4, position)
READS (real4, velocity)
WRITES(uint, watch_parts)

layout(local_size_x = 64) in;

real squared(real3 a) {
  precise real q = (a.x * a.x + a.y * a.y) + a.z * a.z;
  return q;
}

void main() {
  uint i = gl_GlobalInvocationID.x, piece = gl_GlobalInvocationID.y, nx = params.nx, ny = params.ny;
  uint pieces = (ny + kWatchRows - 1u) / kWatchRows;
  if (i >= nx || piece >= pieces) return;
  uint fastest = 0u, particle = piece * kWatchRows * nx + i, energy = 0u;
  for (uint j = piece * kWatchRows; j < min(ny, (piece + 1u) * kWatchRows); ++j) {
    uint p = j * nx + i;
    real4 x = position[p];
    real q = squared(velocity[p].xyz), r = squared(x.xyz);
    uint speed_bits = floatBitsToUint(float(q)) & 0x7fffffffu;
    bool finite = max(speed_bits, floatBitsToUint(float(r)) & 0x7fffffffu) < kWatchInfinite;
    bool moves = finite && x.w != 0.0 && q > kWatchSpeedSquaredMin;
    uint key = finite ? (moves ? speed_bits : 0u) : kWatchNotFinite;
    if (key > fastest) {
      fastest = key;
      particle = p;
    }
    if (!moves) continue;
    precise real mass = 1.0 / x.w;
    precise real share = (q * mass) * params.energy_share_s2_m2;
    energy = min(energy + uint(min(share, kWatchShareMost)), kWatchMost);
  }
  uint part = piece * nx + i, parts = nx * pieces;
  watch_parts[kPartFastest * parts + part] = fastest;
  watch_parts[kPartParticle * parts + part] = particle;
  watch_parts[kPartEnergy * parts + part] = energy;
}
