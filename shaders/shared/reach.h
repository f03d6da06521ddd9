// Whether the cloth comes near a capsule, a box or a mesh: words of `reach_groups`, the workgroups of the
// passes of contact, which run in those substeps alone.
#ifndef WEFT_SHARED_REACH_H
#define WEFT_SHARED_REACH_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kReachSolids = 0u;  // x, y, z of solid_contact; x = 0: nothing is near
WEFT_CONST uint kReachMeshes = 3u;  // of mesh_contact
WEFT_CONST uint kReachWords = 6u;
WEFT_CONST uint kReachGroup = 64u;  // invocations of a workgroup of those passes, along a row

WEFT_SHARED_END
#endif
