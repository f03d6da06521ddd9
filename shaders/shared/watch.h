// What the passes watch, judge and keep_sound agree on: which sums there are, and the words that say whether
// the simulation is still sound. docs/physics.md "Divergence" states the bound.
#ifndef WEFT_SHARED_WATCH_H
#define WEFT_SHARED_WATCH_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kWatchRows = 16u;                  // rows of one column that an invocation of `watch` takes
WEFT_CONST uint kWatchWhole = 0x40000000u;         // all the kinetic energy that the scene can have given
WEFT_CONST uint kWatchMost = 0x7fffffffu;          // sums of shares end here, so that no sum wraps around
WEFT_CONST float kWatchShareMost = 2147483520.0f;  // the largest float below kWatchMost: a particle's most
WEFT_CONST uint kWatchInfinite = 0x7f800000u;      // the bits of infinity; those of NaN are greater
WEFT_CONST uint kWatchNotFinite = 0x7fc00000u;     // stands for every particle that is not finite
WEFT_CONST float kWatchSpeedSquaredMin = 1e-30f;  // m²/s²; less counts as rest, whether devices flush or not

// `watch_parts` holds three planes of one word an invocation of `watch`, column by column of the cloth.
WEFT_CONST uint kPartFastest = 0u;   // bits of the greatest squared speed, or kWatchNotFinite
WEFT_CONST uint kPartParticle = 1u;  // who has it: the first by index
WEFT_CONST uint kPartEnergy = 2u;    // shares of kWatchWhole
WEFT_CONST uint kPartPlanes = 3u;

// Words of `watch_state`, which change only as long as the simulation is sound.
WEFT_CONST uint kWatchStopped = 0u;  // not 0: it is not
WEFT_CONST uint kWatchSound = 1u;  // how often it was found sound since the host wrote a state, that one too
WEFT_CONST uint kWatchFastest = 2u;
WEFT_CONST uint kWatchParticle = 3u;
WEFT_CONST uint kWatchEnergy = 4u;
WEFT_CONST uint kWatchStateWords = 5u;

WEFT_SHARED_END
#endif
