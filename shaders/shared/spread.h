// Whether a cloth with self-collision stays spread out over a plane, nowhere folded: words of `spread_state`,
// that the host and `integrate` and `spread_look` of such a frame agree on. docs/float-form.md "Spread" has
// the proof that nothing is in reach of anything else then.
#ifndef WEFT_SHARED_SPREAD_H
#define WEFT_SHARED_SPREAD_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kSpreadRows = 16u;    // rows of one column that an invocation of spread_look takes
WEFT_CONST uint kSpreadMargins = 3u;  // by how much edges may change while the cloth stays spread
WEFT_CONST uint kSpreadSamples = 8u;  // of each border of the cloth, for the plane

// What is found, in all looks since the host wrote the words: largest values, as the bits of floats.
WEFT_CONST uint kSpreadKicked = 0u;    // 1: somebody's velocity changed by more than was allowed in a substep
WEFT_CONST uint kSpreadShort = 1u;     // a bit for each margin by which the cloth is not spread
WEFT_CONST uint kSpreadFound = 2u;     // the first of these:
WEFT_CONST uint kSpreadApart2 = 2u;    // square of neighbours' relative speed [m²/s²]
WEFT_CONST uint kSpreadSpeed2 = 3u;    // of a speed, the shared one taken away [m²/s²]
WEFT_CONST uint kSpreadPlace2 = 4u;    // of the distance from the origin [m²]
WEFT_CONST uint kSpreadLongest2 = 5u;  // of an edge's length [m²]
WEFT_CONST uint kSpreadKick2 = 6u;     // of what the latest substep changed of a velocity [m²/s²]
WEFT_CONST uint kSpreadFoundCount = 5u;
// Of the latest look: edges from the first column to the last and from the first row to the last, added up
// over the samples [m], by which the next frame chooses its plane; and the middle particle's velocity [m/s].
WEFT_CONST uint kSpreadAlong = 7u;
WEFT_CONST uint kSpreadDown = 10u;
WEFT_CONST uint kSpreadMiddle = 13u;
// What the host says.
WEFT_CONST uint kSpreadKickMost2 = 16u;  // of a velocity's change in a substep [m²/s²]; 0: nobody tells
WEFT_CONST uint kSpreadAxis1 = 17u;      // of the plane
WEFT_CONST uint kSpreadAxis2 = 20u;
WEFT_CONST uint kSpreadShared = 23u;      // velocity that speeds are taken relative to [m/s]
WEFT_CONST uint kSpreadLeast = 26u;       // for each margin: how far cells have to go along the plane [m]
WEFT_CONST uint kSpreadLocalLeast = 29u;  // and along that of their surroundings
WEFT_CONST uint kSpreadFirst = 32u;       // the widest margin that is asked for: those before it say nothing
WEFT_CONST uint kSpreadStateWords = 33u;

WEFT_SHARED_END
#endif
