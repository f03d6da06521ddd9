// The parameter block: values that may change between frames without recompiling the plan, and the
// layout of the per-frame substep table. Read by every pass; written by src/sim, from the Model.
#ifndef WEFT_SHARED_PARAMS_H
#define WEFT_SHARED_PARAMS_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kMaxCloths = 64u;              // documented limit of [cloth] and [[cloths]] together
WEFT_CONST uint kMaxSpheres = 64u;             // documented limit of [[spheres]]
WEFT_CONST uint kMaxSolids = 64u;              // documented limit of [[capsules]] and [[boxes]] together
WEFT_CONST uint kMaxMeshes = 8u;               // documented limit of [[meshes]]
WEFT_CONST uint kMaxMovedPins = 64u;           // documented limit of [[pins]] that move or let go
WEFT_CONST uint kMovedPinsWide = 4096u;        // particles in a row of the passes over what they hold
WEFT_CONST float kTinyLengthSquared = 1e-24f;  // m², guards 1/length of coincident particles
WEFT_CONST float kNoLength = 1e-12f;           // m; a shorter vector from a sphere's centre has no direction
WEFT_CONST float kNoNormal = 1e-30f;           // m²; a shorter sum of triangle normals has no direction

// A spring's coefficients in the folded float form, physics page "The float form":
// x = K, stiffness with folded bending [N/m]; y = L = k·rest [N]; z = c, damping [N·s/m]; w unused.
// Rows of `structural`: (direction·2 + on_boundary_line)·3 + number of bending triples (0, 1, 2) whose
// neighbour pair this is. Rows of `flex`: direction·2 + on_boundary_line. direction 0 = along i, 1 = along j.
WEFT_REAL_STRUCT(Params) {
  real4 structural[12];
  real4 flex[4];
  real4 shear;
  real3 gravity_m_s2;
  real inverse_mass_1_kg;  // of an interior particle; position.w scales it (0 pinned, 1, 2 edge, 4 corner)
  real floor_height_m;     // the surface a particle rests on: floor plus half the cloth's thickness
  real floor_friction;
  uint nx, ny;  // particles along i; rows of all cloths together, one below the other (sheets.glsl)
  uint sphere_count;
  uint row_stride;  // real4s from one row of the substep table to the next
  // What watch.h's kWatchWhole is of m/m0·v²; the host writes it each frame. 0: energy is not looked at.
  real energy_share_s2_m2;
};
#ifdef __cplusplus
using Params = ParamsOf<float>;
#endif

// The substep table is an array of real4; row r starts at r·row_stride and belongs to dispatch r of the
// frame: kick, drift, contact. All of it is computed on the host in double and rounded once.
//   [0] xyz = alpha·wind(t) at the kick's time [m/s²]    w = 1 - e, what the kick's air takes
//       (Runge-Kutta: w = alpha itself [1/s])
//   [1] x = phi, the kick's gain [s]   y = h, the drift's length [s]
//       z = gain, w = loss of the prediction that follows (velocity Verlet); 0 without
//   then three real4 a sphere, in scene order:
//   [2+3s] xyz = centre at the drift's end [m]           w = reach: radius + half thickness [m]
//   [3+3s] xyz = the centre's travel during the drift [m]  w = friction coefficient
//   [4+3s] xyz = velocity at the drift's end [m/s]       w unused
//   then two real4 a pin that moves or lets go, in scene order:
//   [0] xyz = its offset at the drift's end [m]          w = 1 once it has let go
//   [1] xyz = its mean velocity during the drift [m/s]   w unused
//   then ten real4 a capsule or box, capsules first, in scene order:
//   [0] xyz = centre at the drift's end [m]              w = reach: radius + half thickness [m]
//   [1] xyz = centre at the drift's start [m]            w = friction coefficient
//   [2] xyz = the centre's velocity [m/s]                w = depth that stops a path at its entry [m]
//   [3] xyz = angular velocity [rad/s]                   w unused
//   [4] to [6] xyz = its own axes at the drift's end     w = half edges of the box inside the rounding [m]
//   [7] to [9] xyz = its own axes at the drift's start   w unused
//   then twelve real4 a mesh, in scene order: the ten of a box, whose half edges are not used, and
//   [10] xyz = lowest corner of its distance grid in its own frame [m]  w = edge of a cell [m]
//   [11] xyz = samples along its own axes                w = number of its first sample in distance_grids
//   then three real4 with [aerodynamics]:
//   [0] xyz = wind(t) [m/s], gusts included              w = share of the noise's next slice of time
//   [1] xyz = where the noise's lattice is [cells]       w = 1/edge of its cells [1/m]
//   [2] x = the slice of time  y = the noise's amplitude [m/s]  z, w = density/12 times drag, lift [kg/m³]
//   then one real4 where the floor is tilted: xyz = its normal, w = what normal·x is on it [m]
//   then three real4 where the cloth is asked whether it comes near a body or a limit (src/passes/reach.h):
//   [0] xyz = lowest corner of all that is near [m]      w = a longer drift counts as near [m]
//   [1] xyz = highest corner [m]                         w unused
//   [2] squares [m²] of what is near the limit: x, y = a structural link, a diagonal; z = a drift
WEFT_CONST uint kRowHeadVec4s = 2u;
WEFT_CONST uint kRowSphereVec4s = 3u;
WEFT_CONST uint kRowPinVec4s = 2u;
WEFT_CONST uint kRowSolidVec4s = 10u;
WEFT_CONST uint kRowFloorVec4s = 1u;
WEFT_CONST uint kRowMeshVec4s = 12u;
WEFT_CONST uint kRowAirVec4s = 3u;
WEFT_CONST uint kRowReachVec4s = 3u;
WEFT_CONST uint kSolidNewtonSteps = 16u;  // in search of where a path enters a capsule or box

WEFT_CONST int kNoisePeriodMask = 1023;   // the wind's noise repeats after so many cells
WEFT_CONST float kNoiseFarthest = 1e6f;   // cells; farther out there is no noise of its own
WEFT_CONST uint kMeshMarchSteps = 1024u;  // half cells of a distance grid that one drift is followed through
WEFT_CONST uint kMeshBisections = 8u;     // in search of where a path enters a mesh
WEFT_CONST uint kMeshProjections = 2u;    // onto a mesh's surface before the last one

// A particle that a moving pin holds: its place is anchor + the pin's offset.
WEFT_REAL_STRUCT(MovedPin) {
  real3 anchor_m;  // at the cloth's start, without the offset
  uint particle;
  uint pin;  // the how-manieth of those that move
};

// What keeps a particle within reach of the pinned one that is nearest on the flat cloth.
WEFT_REAL_STRUCT(Tether) {
  uint anchor;   // a pinned particle
  real reach_m;  // the farthest from it; below 0 where the particle is pinned itself
};

// The rows of `constraints`, which XPBD alone has: x = rest [m], y = compliance 1/k [m/N], z = damping time
// c/k [s]. Structural, flex and bending rows come in pairs: inside, then on a boundary line. Where warp and
// weft differ, as many rows again follow for what lies along j.
WEFT_CONST uint kConstraintStructural = 0u;
WEFT_CONST uint kConstraintShear = 2u;
WEFT_CONST uint kConstraintFlex = 3u;
WEFT_CONST uint kConstraintBend = 5u;
WEFT_CONST uint kConstraintRows = 7u;

// The rows of `strain_limits`: x = the longest a spring may be [m], y = its square [m²].
WEFT_CONST uint kLimitStructural = 0u;
WEFT_CONST uint kLimitShear = 1u;
WEFT_CONST uint kLimitRows = 2u;

WEFT_SHARED_END
#endif
