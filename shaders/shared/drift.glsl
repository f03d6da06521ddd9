// Sums of a particle's position and velocity, plain or by Kahan: `compensation` holds what positions, then
// velocities, have too much.

real3 added(uint slot, real3 a, real3 b) {
#ifdef COMPENSATED
  precise real3 wanted = b - compensation[slot].xyz;
  precise real3 sum = a + wanted;
  precise real3 taken = sum - a;
  precise real3 excess = taken - wanted;
  compensation[slot] = real4(excess, 0.0);
#else
  precise real3 sum = a + b;
#endif
  return sum;
}

real3 kicked_at(uint p, Step s, real3 v0, real3 acc) {
  return added(params.nx * params.ny + p, v0, kick_change(s.loss, s.gain, v0, acc));
}

real3 drifted_at(uint p, Step s, real3 x0, real3 v) {
  precise real3 travelled = s.drift * v;
  return added(p, x0, travelled);
}

// Contact after a drift; what it moves has nothing left over.
void touched_at(uint p, Step s, real3 x0, inout real3 x1, inout real3 v) {
  real3 free_x = x1, free_v = v;
  contact(s.row, x0, x1, v);
#ifdef COMPENSATED
  if (x1 != free_x || v != free_v) {
    compensation[p] = real4(0.0);
    compensation[params.nx * params.ny + p] = real4(0.0);
  }
#endif
}
