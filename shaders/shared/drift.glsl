// Sums of a particle's position and velocity, plain or by Kahan: `compensation` holds what positions, then
// velocities, have too much.

vec3 added(uint slot, vec3 a, vec3 b) {
#ifdef COMPENSATED
  precise vec3 wanted = b - compensation[slot].xyz;
  precise vec3 sum = a + wanted;
  precise vec3 taken = sum - a;
  precise vec3 excess = taken - wanted;
  compensation[slot] = vec4(excess, 0.0);
#else
  precise vec3 sum = a + b;
#endif
  return sum;
}

vec3 kicked_at(uint p, Step s, vec3 v0, vec3 acc) {
  return added(params.nx * params.ny + p, v0, kick_change(s.loss, s.gain, v0, acc));
}

vec3 drifted_at(uint p, Step s, vec3 x0, vec3 v) {
  precise vec3 travelled = s.drift * v;
  return added(p, x0, travelled);
}

// Contact after a drift; what it moves has nothing left over.
void touched_at(uint p, Step s, vec3 x0, inout vec3 x1, inout vec3 v) {
  vec3 free_x = x1, free_v = v;
  contact(s.row, x0, x1, v);
#ifdef COMPENSATED
  if (x1 != free_x || v != free_v) {
    compensation[p] = vec4(0.0);
    compensation[params.nx * params.ny + p] = vec4(0.0);
  }
#endif
}
