#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"
#include "../shared/links.h"

// Breaks the links that are longer than the cloth bears: between neighbours along both directions and both
// diagonals of a cell. A broken link stays so, and from the first on integrate_torn moves the cloth.
// Each invocation writes the word of its own particle and reads positions only: no races. Whoever breaks a
// link gives integrate_torn the same workgroups, whatever the order.
// Source: Terzopoulos and Fleischer 1988, Modeling inelastic deformation, section 5; docs/float-form.md
// "Tearing".

READS (real4, strain_limits)
READS (real4, position)
UPDATES(uint, broken_links)
UPDATES(uint, reach_groups)

layout(local_size_x = 64) in;

#include "../shared/dot.glsl"
#include "../shared/reach.h"

uint bit_if_longer(uint a, uint b, uint row, uint bit) {
  precise real3 d = position[b].xyz - position[a].xyz;
  return dot3(d, d) > strain_limits[row].y ? bit : 0u;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, nx = params.nx;
  if (i >= nx || j >= params.ny) return;
  if (i == 0u && j == 0u) reach_groups[kReachTear] = 0u;  // asked for in this substep alone
  uint p = j * nx + i, before = broken_links[p], now = before;
  bool right = i + 1u < nx, below = j + 1u < params.ny;
  if (right) now |= bit_if_longer(p, p + 1u, kLimitStructural, kLinkAlongI);
  if (below) now |= bit_if_longer(p, p + nx, kLimitStructural, kLinkAlongJ);
  if (right && below) {
    now |= bit_if_longer(p, p + nx + 1u, kLimitShear, kLinkFalling);
    now |= bit_if_longer(p + 1u, p + nx, kLimitShear, kLinkRising);
  }
  if (now == before) return;
  broken_links[p] = now;
  atomicMax(reach_groups[kReachTorn], (nx + kReachGroup - 1u) / kReachGroup);
}
