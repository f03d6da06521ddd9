// Whether some passes have anything to do: words of `reach_groups`, the workgroups of contact with bodies, of
// the strain limit and of tearing, which run in those substeps alone.
#ifndef WEFT_SHARED_REACH_H
#define WEFT_SHARED_REACH_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kReachSolids = 0u;      // x, y, z of solid_contact; x = 0: nothing is near
WEFT_CONST uint kReachMeshes = 3u;      // of mesh_contact
WEFT_CONST uint kReachLinks = 6u;       // of strain_limit: links along i and diagonals
WEFT_CONST uint kReachLinksDown = 9u;   // of strain_limit: links along j
WEFT_CONST uint kReachAsksLinks = 12u;  // 1: links are looked at; 0: their words mean nothing
WEFT_CONST uint kReachWords = 13u;
WEFT_CONST uint kReachTear = 13u;  // of tear; these six in scenes with tearing alone
WEFT_CONST uint kReachTorn = 16u;  // of integrate_torn; from the first broken link on it moves the cloth
WEFT_CONST uint kReachWordsTearing = 19u;
WEFT_CONST uint kReachGroup = 64u;  // invocations of a workgroup of those passes, along a row

WEFT_SHARED_END
#endif
