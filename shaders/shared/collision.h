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
  uint centre;       // the particle that motion is measured against
};
#ifdef __cplusplus
using Collision = CollisionOf<float>;
#endif

// Words of `collision_state`. The first six are the workgroups of two indirect dispatches (x, y, z): of the
// passes over the cloth that make the lists anew, and of the scan. x = 0: the lists hold and nothing runs.
WEFT_CONST uint kListGroups = 0u;
WEFT_CONST uint kScanGroups = 3u;
WEFT_CONST uint kListsBuilt = 6u;    // how often the lists were made
WEFT_CONST uint kPairsDropped = 7u;  // entries that found no room in a list, all times together
WEFT_CONST uint kCollisionStateWords = 8u;
WEFT_CONST uint kCollisionGroup = 64u;  // invocations of a workgroup over the cloth

WEFT_SHARED_END
#endif
