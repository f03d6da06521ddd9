// The row of the substep table that a dispatch reads, and the kick it says. The including pass declares
// READS(real4, substeps) and includes effects.glsl first.

// The dispatch's row of the table and what else is the same for all particles, read once.
struct Step {
  uint row;
  real inverse_mass, loss, gain, drift, predict_gain, predict_loss;
  real3 alpha_wind, gravity_m_s2;
};

Step step_of(uint row) {
#ifdef HOLDS_SPHERES
  hold_spheres(row);
#endif
#ifdef WEFT_REACH
  hold_reach(row);
#endif
#ifdef WEFT_SPREAD
  hold_spread();
#endif
  real4 air_row = substeps[row], times = substeps[row + 1u];
  return Step(row, params.inverse_mass_1_kg, air_row.w, times.x, times.y, times.z, times.w, air_row.xyz,
              params.gravity_m_s2);
}

// Of springs, gravity and wind, without the air's drag [m/s²].
real3 acceleration(Step s, real3 F, real w) {
  precise real3 acc = F * w;
  if (gravity) acc = acc + s.gravity_m_s2;
  if (wind) acc = acc + s.alpha_wind;
  return acc;
}

// What the exact kick of docs/float-form.md "Kick and drift" adds to v0, with the row's loss and gain or
// another pair.
real3 kick_change(real loss, real gain, real3 v0, real3 acc) {
  precise real3 change = gain * acc;
  if (air) {
    precise real3 lost = loss * v0;
    change = change - lost;
  }
  return change;
}

real3 kicked(Step s, real3 v0, real3 acc) {
  precise real3 v = v0 + kick_change(s.loss, s.gain, v0, acc);
  return v;
}
