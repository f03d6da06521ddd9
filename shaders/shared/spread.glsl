// Tells whether some velocity changed by more in this substep than the host allows, or some way differs from
// what the velocity before it promised by more than that: docs/float-form.md "Spread" says what follows. A
// module without WEFT_SPREAD has none of it. The including pass includes contact.glsl before this and
// kick.glsl after it.
#ifdef WEFT_SPREAD
#include "spread.h"
UPDATES(uint, spread_state)

real kick_most2 = 0.0;    // of a velocity's change [m²/s²]
bool kicked_far = false;  // a particle of this invocation

void hold_spread() { kick_most2 = real(uintBitsToFloat(spread_state[kSpreadKickMost2])); }

bool is_farther(real3 d, real most2) {
  precise real q = (d.x * d.x + d.y * d.y) + d.z * d.z;
  return !(q <= most2);
}

// Of a free particle that came from x0 with v0 to x1 with v1.
void look_at_kick(real drift, real3 x0, real3 v0, real3 x1, real3 v1) {
  precise real3 change = v1 - v0;
  kicked_far = is_farther(change, kick_most2) ? true : kicked_far;
  if (!(spheres || floor_contact) || !(drift > 0.0)) return;
  precise real3 promised = drift * v0;
  precise real3 strayed = (x1 - x0) - promised;
  precise real most2 = (drift * drift) * kick_most2;
  kicked_far = is_farther(strayed, most2) ? true : kicked_far;
}

void tell_kicks() {
  if (!kicked_far) return;
  if (subgroupElect()) atomicOr(spread_state[kSpreadKicked], 1u);
}
#else
#define hold_spread()
#define look_at_kick(drift, x0, v0, x1, v1)
#define tell_kicks()
#endif
