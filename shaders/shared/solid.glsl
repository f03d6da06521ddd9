// Contact with capsules and boxes: boxes rounded by a radius, in a frame that moves and turns. Swept, with
// Coulomb friction: docs/float-form.md, "Capsules and boxes". The including pass declares READS(real4,
// substeps) and includes dot.glsl, cross.glsl and
// respond.glsl first.

struct Near {
  real d;   // distance from the surface, negative inside [m]
  real3 n;  // its gradient, a unit vector out of the body
};

// Of a point in the body's own frame.
Near near_rounded_box(real3 p, real3 half_m, real reach) {
  precise real3 q = abs(p) - half_m;
  real3 side = real3(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0, p.z < 0.0 ? -1.0 : 1.0);
  real3 o = max(q, real3(0.0));
  precise real l = sqrt(dot3(o, o));
  Near near;
  if (l > kNoLength) {
    precise real inverse = 1.0 / l;
    precise real3 out_of = o * inverse;
    near.n = side * out_of;
    near.d = l - reach;
    return near;
  }
  bool by_x = q.x >= q.y && q.x >= q.z, by_y = !by_x && q.y >= q.z;
  precise real d = (by_x ? q.x : (by_y ? q.y : q.z)) - reach;
  near.n = by_x ? real3(side.x, 0.0, 0.0) : (by_y ? real3(0.0, side.y, 0.0) : real3(0.0, 0.0, side.z));
  near.d = d;
  return near;
}

// Newton's method from t on, along p0 + t·D, for where the distance falls to `level`. The distance from a
// convex body is a convex function along a line, so that it comes from the left and never passes the place.
bool falls_to(real level, real near_enough, real3 p0, real3 D, real3 half_m, real reach, inout real t) {
  for (uint k = 0u; k < kSolidNewtonSteps; ++k) {
    precise real3 way = t * D;
    precise real3 p = p0 + way;
    Near near = near_rounded_box(p, half_m, reach);
    precise real above = near.d - level;
    if (above <= near_enough) return true;
    precise real slope = dot3(near.n, D);
    if (slope >= 0.0) return false;
    precise real on = above / slope;
    t = t - on;
    if (t > 1.0) return false;
  }
  return false;
}

// The point of contact in the body's own frame. A path p0 → p1 that went deep goes on along the surface from
// where it entered: its end is moved onto the tangent plane there, behind which the whole of a convex body
// lies. Else its end.
real3 solid_stop(real3 p0, real3 p1, real3 half_m, real reach, real deep, out Near near, out bool hit) {
  precise real3 D = p1 - p0;
  precise real dd = dot3(D, D);
  precise real shallow = deep * deep;
  near = near_rounded_box(p1, half_m, reach);
  hit = near.d < 0.0;
  if (!(dd > shallow)) return p1;
  Near start = near_rounded_box(p0, half_m, reach);
  precise real far = start.d * start.d;
  if (start.d < -deep || (start.d > 0.0 && far > dd)) return p1;
  precise real near_enough = real(0.25) * deep;
  precise real t = 0.0;
  if (!falls_to(-deep, near_enough, p0, D, half_m, reach, t)) return p1;
  t = 0.0;
  falls_to(real(0.0), near_enough, p0, D, half_m, reach, t);
  precise real3 way = t * D;
  precise real3 entry = p0 + way;
  Near at = near_rounded_box(entry, half_m, reach);
  precise real3 inwards = at.d * at.n;
  precise real3 surface = entry - inwards;
  precise real3 beyond = p1 - surface;
  precise real rise = dot3(beyond, at.n);
  if (!(rise < 0.0)) return p1;
  precise real3 up = rise * at.n;
  precise real3 slid = p1 - up;
  near.n = at.n;
  near.d = 0.0;
  hit = true;
  return slid;
}

real3 in_frame(uint axes, real3 r) {
  return real3(dot3(substeps[axes].xyz, r), dot3(substeps[axes + 1u].xyz, r),
               dot3(substeps[axes + 2u].xyz, r));
}

real3 in_world(uint axes, real3 p) {
  precise real3 x = p.x * substeps[axes].xyz;
  precise real3 y = p.y * substeps[axes + 1u].xyz;
  precise real3 z = p.z * substeps[axes + 2u].xyz;
  precise real3 sum = (x + y) + z;
  return sum;
}

// Puts x1 on the surface at the point `p` of the body's frame, and takes the approach from v.
void touch_solid(uint row, real3 p, Near near, inout real3 x1, inout real3 v) {
  real4 place = substeps[row], start = substeps[row + 1u];
  precise real3 inwards = near.d * near.n;
  precise real3 surface = p - inwards;
  precise real3 arm = in_world(row + 4u, surface);
  precise real3 stopped = place.xyz + arm;
  precise real3 carried = substeps[row + 2u].xyz + cross3(substeps[row + 3u].xyz, arm);
  x1 = stopped;
  v = respond(v, carried, in_world(row + 4u, near.n), start.w);
}

void solid_touch(uint row, real3 x0, inout real3 x1, inout real3 v) {
  real4 place = substeps[row];
  real3 half_m = real3(substeps[row + 4u].w, substeps[row + 5u].w, substeps[row + 6u].w);
  precise real3 from = x0 - substeps[row + 1u].xyz;
  precise real3 to = x1 - place.xyz;
  Near near;
  bool hit;
  real3 p = solid_stop(in_frame(row + 7u, from), in_frame(row + 4u, to), half_m, place.w,
                       substeps[row + 2u].w, near, hit);
  if (hit) touch_solid(row, p, near, x1, v);
}
