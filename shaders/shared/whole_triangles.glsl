// Whether the triangles A and B of the cell that particle p names are whole: always, but where links break
// (TORN).
#ifdef TORN
#include "links.h"

READS (uint, broken_links)

bool whole_a(uint p) { return (broken_links[p] & (kLinkAlongI | kLinkAlongJ | kLinkRising)) == 0u; }

bool whole_b(uint p) {
  return ((broken_links[p] & kLinkRising) | (broken_links[p + 1u] & kLinkAlongJ) |
          (broken_links[p + params.nx] & kLinkAlongI)) == 0u;
}
#else
bool whole_a(uint p) { return true; }
bool whole_b(uint p) { return true; }
#endif
