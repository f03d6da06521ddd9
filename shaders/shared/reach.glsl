// Tells whether some particle's drift comes near a capsule, a box or a mesh, so that the passes of contact
// have workgroups: src/passes/reach.h says why nothing else can touch one. A module without WEFT_REACH has
// none of it. The including pass declares READS(real4, substeps) and includes this before kick.glsl.
#ifdef WEFT_REACH
#include "reach.h"
UPDATES(uint, reach_groups)

real4 reach_low, reach_high;  // corners; w of the first: a longer drift counts as near [m]
bool reached = false;         // by a particle of this invocation

// The last rows of the dispatch's row of the table, which is the same for all particles.
void hold_reach(uint row) {
  uint at = row + params.row_stride - kRowReachVec4s;
  reach_low = substeps[at];
  reach_high = substeps[at + 1u];
}

void look_for_bodies(real3 x0, real3 x1) {
  real3 gone = abs(x1 - x0);
  bool leaps = !(max(max(gone.x, gone.y), gone.z) < reach_low.w);
  bool inside = all(greaterThan(x1, reach_low.xyz)) && all(lessThan(x1, reach_high.xyz));
  reached = reached || inside || leaps;
}

// Integers alone, so that it does not matter who comes first.
void tell_reach() {
  if (!reached) return;
  uint groups = (params.nx + kReachGroup - 1u) / kReachGroup;
  atomicMax(reach_groups[kReachSolids], groups);
  atomicMax(reach_groups[kReachMeshes], groups);
}
#else
#define hold_reach(row)
#define look_for_bodies(x0, x1)
#define tell_reach()
#endif
