// A Runge-Kutta stage: the slope at what `position` and `velocity` hold. A row's gain is the stage's weight
// in the step, its drift the stage's reach, its loss the air's rate. Includes after kick.glsl.
struct Slope {
  vec3 x, v;  // [m/s], [m/s²]; zero where the particle is pinned
};

Slope slope_at(Step s, Column c, inout March m) {
  vec3 v = damping ? m.own.v : velocity[m.p].xyz;
  precise vec3 F = spring_force(c, m);
  precise float w = position[m.p].w * s.inverse_mass;
  if (pins && w == 0.0) return Slope(vec3(0.0), vec3(0.0));
  precise vec3 acc = acceleration(s, F, w);
  if (air) {
    precise vec3 drag = s.loss * v;
    acc = acc - drag;
  }
  return Slope(v, acc);
}

bool is_pinned(float relative) { return pins && relative == 0.0; }
