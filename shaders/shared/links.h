// The bits of broken_links: which of the links that a particle names are broken.
#ifndef WEFT_SHARED_LINKS_H
#define WEFT_SHARED_LINKS_H
#include "types.h"

WEFT_SHARED_BEGIN

WEFT_CONST uint kLinkAlongI = 1u;   // (i,j) to (i+1,j)
WEFT_CONST uint kLinkAlongJ = 2u;   // (i,j) to (i,j+1)
WEFT_CONST uint kLinkFalling = 4u;  // (i,j) to (i+1,j+1)
WEFT_CONST uint kLinkRising = 8u;   // (i+1,j) to (i,j+1), named by (i,j)

WEFT_SHARED_END
#endif
