// Moves one particle by kick, drift and contact once its force is known. The including pass includes
// contact.glsl and kick.glsl first.

#ifdef LATE_SPHERES
bool near_sphere;  // the particle just moved: its contact is then to come
#else
const bool near_sphere = false;
#endif

// @param relative  the particle's inverse mass over an interior particle's; 0 when pinned
// @param x, v      [m], [m/s]; before the substep, then after it
void step_particle(Step s, real3 F, real relative, inout real3 x, inout real3 v) {
#ifdef LATE_SPHERES
  near_sphere = false;
#endif
  precise real w = relative * s.inverse_mass;
  if (pins && w == 0.0) return;
  precise real3 v1 = kicked(s, v, acceleration(s, F, w));
  precise real3 travelled = s.drift * v1;
  precise real3 x1 = x + travelled;
  bool touches = (spheres || floor_contact) && s.drift > 0.0;
#ifdef LATE_SPHERES
  near_sphere = late_spheres && touches && may_touch_sphere(x, x1);
  if (late_spheres && touches && !near_sphere) touch_floor(x1, v1);
#endif
  if (!late_spheres && touches) contact(s.row, x, x1, v1);
#ifdef WEFT_REACH
  if (!near_sphere) look_for_bodies(x, x1);
#endif
#ifdef WEFT_SPREAD
  if (!near_sphere) look_at_kick(s.drift, x, v, x1, v1);
#endif
  x = x1;
  v = v1;
}
