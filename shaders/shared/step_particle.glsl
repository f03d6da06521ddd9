// Moves one particle by kick, drift and contact once its force is known. The including pass includes
// contact.glsl and kick.glsl first.

// @param relative  the particle's inverse mass over an interior particle's; 0 when pinned
// @param x, v      [m], [m/s]; before the substep, then after it
void step_particle(Step s, real3 F, real relative, inout real3 x, inout real3 v) {
  precise real w = relative * s.inverse_mass;
  if (pins && w == 0.0) return;
  precise real3 v1 = kicked(s, v, acceleration(s, F, w));
  precise real3 travelled = s.drift * v1;
  precise real3 x1 = x + travelled;
  if ((spheres || floor_contact) && s.drift > 0.0) contact(s.row, x, x1, v1);
#ifdef WEFT_REACH
  look_for_bodies(x, x1);
#endif
  x = x1;
  v = v1;
}
