// One entry of a particle's list of surfaces as it is at near_position: which particles, with which weights,
// how far apart. The including pass includes surface.glsl and declares near_position first.

struct Touching {
  uvec4 particle;
  real4 weight;  // of each particle's motion in the distance: they add up to 0
  uint ends;     // how many of them, from the front, are on the first side
  real3 d;       // from the second side's nearest point to the first's
  real q;        // its square
};

uint neighbour(Cells c, uint particle, uint k) {
  return uint(int(particle) + kRing[k].y * int(c.nx) + kRing[k].x);
}

Touching touching_of(Cells c, uint particle, uint entry) {
  Touching it;
  uint code = entry >> kSurfaceCodeShift;
  uint q = particle_at(c, entry & ((1u << kSurfaceCodeShift) - 1u));
  real3 here = near_position[particle].xyz, there = near_position[q].xyz;
  if (code >= kSurfaceTriangle) {
    uint k = code - kSurfaceTriangle;
    it.particle = uvec4(particle, q, neighbour(c, q, k), neighbour(c, q, next_in_ring(k)));
    it.ends = 1u;
    real3 b = near_position[it.particle.z].xyz, corner = near_position[it.particle.w].xyz;
    real3 weight = closest_in_triangle(here, there, b, corner);
    it.weight = real4(1.0, -weight);
    it.d = from_triangle(here, there, b, corner, weight);
  } else {
    it.particle = uvec4(particle, neighbour(c, particle, code / 6u), q, neighbour(c, q, code % 6u));
    it.ends = 2u;
    real3 b = near_position[it.particle.y].xyz, f = near_position[it.particle.w].xyz;
    real s, t;
    closest_on_edges(here, b, there, f, s, t);
    precise real rest_s = 1.0 - s, rest_t = 1.0 - t;
    it.weight = real4(rest_s, s, -rest_t, -t);
    it.d = between_edges(here, b, there, f, s, t);
  }
  it.q = dot3(it.d, it.d);
  return it;
}
