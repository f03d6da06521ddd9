// The drift of one particle, plain or with Kahan's compensation: `compensation` holds what position has
// too much.

vec3 drifted(uint p, vec3 x0, float h, vec3 v) {
  precise vec3 travelled = h * v;
#ifdef COMPENSATED
  travelled = travelled - compensation[p].xyz;
#endif
  precise vec3 x1 = x0 + travelled;
#ifdef COMPENSATED
  precise vec3 taken = x1 - x0;
  precise vec3 excess = taken - travelled;
  compensation[p] = vec4(excess, 0.0);
#endif
  return x1;
}

// A place that contact has put a particle in has lost nothing.
void forget_lost(uint p) {
#ifdef COMPENSATED
  compensation[p] = vec4(0.0);
#endif
}
