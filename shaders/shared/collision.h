// What self-collision's passes read that the host computes once from the model: the distance each pair must
// keep, the grid's cells and the room of the lists. Only scenes with [self_collision] have it.
#ifndef WEFT_SHARED_COLLISION_H
#define WEFT_SHARED_COLLISION_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kPairLimitsMax = 257u;  // rows of `limits`; the thickness is at most 10 cells
WEFT_CONST int kOffsetMax = 256;        // offsets on the cloth are cut here before they are squared
WEFT_CONST float kCellsFromOriginMax =
    1e6f;  // beyond, and when it is not a number, a particle has no neighbours

// A particle's place on the cloth in one word: j << column_bits | i. It ascends as the particle's index does.
WEFT_REAL_STRUCT(Collision) {
  // Row m belongs to pairs that are di² + dj² = m cells² apart on the cloth; the last row to all others.
  // x = limit, the distance they keep [m]; y = limit²; z = (limit + skin)²; w unused.
  real4 limits[kPairLimitsMax];
  real inverse_cell_1_m;      // of the grid's cubic cells
  real moved_squared_max_m2;  // of a particle since the lists were made; farther, and they are made anew
  uint limit_last;            // row of all others
  uint column_bits;
  uint bucket_mask;  // buckets − 1; the buckets are a power of two
  uint capacity;     // pairs that a particle's list has room for
  uint carried;      // 1: the motion that all share is taken from everyone's; 0: something is pinned
  // Surfaces: particle and triangle, edge and edge.
  uint surface_capacity;  // entries that a particle's list of them has room for
  real surface_limit_m;   // the distance they keep
  real surface_limit_squared_m2;
  real surface_reach_squared_m2;  // nearer when the lists are made, and they are listed
  real roam_max_m;                // the farthest that a particle may be from where the lists were made
  // Where distances are no less than this times those on the cloth in cells, what is a cell apart is out of
  // reach.
  real flat_min_m;
  real deep_m;       // of what contacts overlap, what counts
  real recover_1_s;  // they part with that much speed a metre of it
  real friction;
  real pair_reach_m;    // of any pair of particles
  real patch_search_m;  // of any two particles that are not beside each other, if no edge is too long
  real patch_search_squared_m2;
};
#ifdef __cplusplus
using Collision = CollisionOf<float>;
#endif

// Words of `collision_state`. Workgroups of indirect dispatches (x, y, z), x = 0: nothing to do. The lists
// are made anew by passes over patches, by the scan and by passes over the cloth.
WEFT_CONST uint kListGroups = 0u;
WEFT_CONST uint kScanGroups = 3u;
WEFT_CONST uint kListsBuilt = 6u;     // how often the lists were made
WEFT_CONST uint kPairsDropped = 7u;   // entries that found no room in a list, all times together
WEFT_CONST uint kContactGroups = 8u;  // x, y, z of the passes that look at what is listed
WEFT_CONST uint kPairsListed = 11u;   // 1: some list has an entry
WEFT_CONST uint kListsArmed = 12u;    // 1: lists were made since the host wrote the state
WEFT_CONST uint kHeldBack = 13u;      // how often a particle's motion was cut, all times together
WEFT_CONST uint kLongestEdge = 14u;   // bits of the longest edge's square [m²] in float
WEFT_CONST uint kSmallestGap = 15u;   // bits of the smallest distance [m] of two surfaces in this frame
WEFT_CONST uint kNearGroups = 16u;    // x, y, z of the passes over those who look round
WEFT_CONST uint kTouchGroups = 19u;   // x, y, z of the passes that push apart
WEFT_CONST uint kWidestBlock = 22u;   // bits of the widest side of a block's box [m] in float
WEFT_CONST uint kBlockGroups = 23u;   // x, y, z of the passes over blocks
WEFT_CONST uint kLookers = 26u;       // particles that look for others, of `lookers`
WEFT_CONST uint kCollisionStateWords = 27u;
WEFT_CONST uint kCarrierSamples = 64u;  // particles whose motion stands for the cloth's
WEFT_CONST uint kCarrierBuilt = 0u;     // rows of `carrier`: since the lists were made [m]
WEFT_CONST uint kCarrierNear = 1u;      // since contacts were last looked at [m]
WEFT_CONST uint kCarrierVelocity = 2u;  // now [m/s]
WEFT_CONST uint kCarrierRows = 3u;
WEFT_CONST uint kInfinity = 0x7f800000u;  // bits of a float

// A particle's motion between two looks at its surroundings is at most this share of the nearest surface's
// distance: two of them never meet, and an eighth is left for rounding.
WEFT_CONST float kRoamShare = 0.4375f;
WEFT_CONST float kWeightMin = 0.25f;           // of what divides a contact: where only a far end is free
WEFT_CONST float kTouchQuantum_1 = 4096.0f;    // units of touch_weight in a whole particle
WEFT_CONST float kClosingMost_m_s = 256.0f;    // of two surfaces; what is above is left to the next time
WEFT_CONST float kKickQuantum_1 = 1048576.0f;  // units of the sums of kicks in a m/s
WEFT_CONST float kEdgeTiny_m2 = 1e-24f;        // guards the closest points of edges without length
WEFT_CONST uint kSurfaceCodeShift = 26u;       // entry of a list: code above, place below
WEFT_CONST uint kSurfaceTriangle = 36u;        // code − this: which triangle round the place
WEFT_CONST uint kSumPlanes = 3u;               // of `surface_sums`: x, y, z
WEFT_CONST int kCellsAcrossMax = 5;            // of the search for surfaces along an axis
// What is known of a patch's cells, in the w of its box: a bit for each that is folded, row by row, and one
// more where a diagonal is creased. And its word of patch_listed: 1 where its particles look for others than
// their neighbours, a bit for each particle that looks at its neighbours, row by row, and one where all do.
WEFT_CONST uint kCreased = 16u;
WEFT_CONST uint kLooksFar = 1u;
WEFT_CONST uint kLooksBeside = 2u;  // of the first particle; those of the others follow
WEFT_CONST uint kCreaseBeside = 32u;
WEFT_CONST float kHalfRoot = 0.70710678f;  // of 1/2
WEFT_CONST uint kCollisionGroup = 64u;     // invocations of a workgroup over the cloth
WEFT_CONST uint kLookGroupsMax = 65535u;   // workgroups that every device has side by side

WEFT_SHARED_END
#endif
