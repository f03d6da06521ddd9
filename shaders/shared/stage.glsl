// A Runge-Kutta stage: the slope at what `position` and `velocity` hold. A row's gain is the stage's weight
// in the step, its drift the stage's reach, its loss the air's rate. Includes after kick.glsl.
struct Slope {
  real3 x, v;  // [m/s], [m/s²]; zero where the particle is pinned
};

Slope slope_at(Step s, Column c, inout March m) {
  real3 v = damping ? m.own.v : velocity[m.p].xyz;
  precise real3 F = spring_force(c, m);
  precise real w = position[m.p].w * s.inverse_mass;
  if (pins && w == 0.0) return Slope(real3(0.0), real3(0.0));
  precise real3 acc = acceleration(s, F, w);
  if (air) {
    precise real3 drag = s.loss * v;
    acc = acc - drag;
  }
  return Slope(v, acc);
}

bool is_pinned(real relative) { return pins && relative == 0.0; }
