// Self-collision between surfaces: the ring of a particle's neighbours, closest points, and an entry of a
// list. docs/float-form.md "Surfaces". The including pass includes cells.glsl and dot.glsl first.

// The neighbours that a particle shares edges with, in a circle; two that follow make a triangle with it.
const ivec2 kRing[6] =
    ivec2[6](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, -1));

uint next_in_ring(uint k) { return k == 5u ? 0u : k + 1u; }

// Whether the particle at ij has that neighbour on its own cloth.
bool has_neighbour(Cells c, ivec2 ij, uint k) {
  int i = ij.x + kRing[k].x, j = int(own_row(uint(ij.y))) + kRing[k].y;
  return i >= 0 && j >= 0 && i < int(c.nx) && j < int(rows_of_cloth());
}

// Weights of a triangle's corners at the point nearest to p.
// Source: Ericson 2005, Real-Time Collision Detection, section 5.1.5.
real3 closest_in_triangle(real3 p, real3 a, real3 b, real3 corner) {
  precise real3 ab = b - a, ac = corner - a, ap = p - a;
  real d1 = dot3(ab, ap), d2 = dot3(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return real3(1.0, 0.0, 0.0);
  precise real3 bp = p - b;
  real d3 = dot3(ab, bp), d4 = dot3(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return real3(0.0, 1.0, 0.0);
  precise real vc = d1 * d4 - d3 * d2, along = d1 - d3;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && along > 0.0) {  // not where the two corners lie on each other
    precise real v = d1 / along;
    precise real rest = 1.0 - v;
    return real3(rest, v, 0.0);
  }
  precise real3 cp = p - corner;
  real d5 = dot3(ab, cp), d6 = dot3(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return real3(0.0, 0.0, 1.0);
  precise real vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    precise real w = d2 / (d2 - d6);
    precise real rest = 1.0 - w;
    return real3(rest, 0.0, w);
  }
  precise real va = d3 * d6 - d5 * d4;
  precise real to_corner = d4 - d3, to_b = d5 - d6;
  if (va <= 0.0 && to_corner >= 0.0 && to_b >= 0.0) {
    precise real w = to_corner / (to_corner + to_b);
    precise real rest = 1.0 - w;
    return real3(0.0, rest, w);
  }
  precise real sum = (va + vb) + vc;
  precise real v = vb / sum, w = vc / sum;
  precise real rest = (1.0 - v) - w;
  return real3(rest, v, w);
}

real share_of(real x) { return min(max(x, 0.0), 1.0); }

// How far along the edges a–b and e–f their nearest points are.
// Source: Ericson 2005, Real-Time Collision Detection, section 5.1.9.
void closest_on_edges(real3 a, real3 b, real3 e, real3 f, out real s, out real t) {
  precise real3 along = b - a, other = f - e, between = a - e;
  real aa = max(dot3(along, along), kEdgeTiny_m2), ee = max(dot3(other, other), kEdgeTiny_m2);
  real mixed = dot3(along, other), ar = dot3(along, between), er = dot3(other, between);
  precise real det = aa * ee - mixed * mixed;
  s = 0.0;
  if (det > 0.0) {
    precise real x = (mixed * er - ar * ee) / det;
    s = share_of(x);
  }
  precise real y = (mixed * s + er) / ee;
  t = y;
  if (y < 0.0) {
    t = 0.0;
    precise real x = -ar / aa;
    s = share_of(x);
  } else if (y > 1.0) {
    t = 1.0;
    precise real x = (mixed - ar) / aa;
    s = share_of(x);
  }
}

// From the triangle's nearest point to p.
real3 from_triangle(real3 p, real3 a, real3 b, real3 corner, real3 weight) {
  precise real3 ab = b - a, ac = corner - a, ap = p - a;
  precise real3 foot = weight.y * ab + weight.z * ac;
  precise real3 d = ap - foot;
  return d;
}

// From the second edge's nearest point to the first's.
real3 between_edges(real3 a, real3 b, real3 e, real3 f, real s, real t) {
  precise real3 along = b - a, other = f - e, between = a - e;
  precise real3 d = (between + s * along) - t * other;
  return d;
}
