// Tells whether some particle's drift comes near a capsule, a box or a mesh, so that the passes of contact
// have workgroups, and whether some link may get longer than the strain limit, or than where it breaks:
// src/passes/reach.h says why nothing else can touch a body or be too long. A module without WEFT_REACH has
// none of it. The including pass declares READS(real4, substeps) and includes this before force.glsl and
// kick.glsl.
#ifdef WEFT_REACH
#include "reach.h"
UPDATES(uint, reach_groups)

layout(constant_id = 28) const bool tears = false;
layout(constant_id = 29) const bool asks_links = false;

// Whether integrate_torn moves the cloth, and `integrate` has nothing to do.
bool is_torn() { return tears && reach_groups[kReachTorn] != 0u; }

real4 reach_links;  // squares: structural link, diagonal, drift
bool tight = false;
real4 reach_low, reach_high;  // corners; w of the first: a longer drift counts as near [m]
bool reached = false;         // by a particle of this invocation

// The last rows of the dispatch's row of the table, which is the same for all particles.
void hold_reach(uint row) {
  uint at = row + params.row_stride - kRowReachVec4s;
  reach_low = substeps[at];
  reach_high = substeps[at + 1u];
  reach_links = substeps[at + 2u];
}

void look_at_link(real3 a, real3 b, bool diagonal) {
  if (!asks_links) return;
  precise real3 d = b - a;
  precise real q = (d.x * d.x + d.y * d.y) + d.z * d.z;
  tight = q <= (diagonal ? reach_links.y : reach_links.x) ? tight : true;
}

void look_for_bodies(real3 x0, real3 x1) {
  precise real3 moved = x1 - x0;
  real3 gone = abs(moved);
  bool leaps = !(max(max(gone.x, gone.y), gone.z) < reach_low.w);
  bool inside = all(greaterThan(x1, reach_low.xyz)) && all(lessThan(x1, reach_high.xyz));
  reached = reached || inside || leaps;
  if (!asks_links) return;
  precise real q = (moved.x * moved.x + moved.y * moved.y) + moved.z * moved.z;
  tight = q < reach_links.z ? tight : true;
}

// Integers alone, so that it does not matter who comes first; one invocation speaks for its subgroup.
void tell_reach() {
  if (!(reached || tight)) return;
  uint groups = (params.nx + kReachGroup - 1u) / kReachGroup;
  if (reached) {
    if (subgroupElect()) {  // not joined by &&: one of those that are near is to speak
      atomicMax(reach_groups[kReachSolids], groups);
      atomicMax(reach_groups[kReachMeshes], groups);
    }
  }
  if (!asks_links) return;
  if (tears) {
    if (subgroupElect()) atomicMax(reach_groups[kReachTear], groups);
    return;
  }
  if (subgroupElect()) {  // what a body touches is moved once more, so that being near one counts here, too
    atomicMax(reach_groups[kReachLinks], ((params.nx + 1u) / 2u + kReachGroup - 1u) / kReachGroup);
    atomicMax(reach_groups[kReachLinksDown], groups);
  }
}
#else
#define hold_reach(row)
#define look_at_link(a, b, diagonal)
#define look_for_bodies(x0, x1)
#define tell_reach()
#endif
