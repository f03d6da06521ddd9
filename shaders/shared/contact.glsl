// Contact of one particle with the spheres and the floor, swept, with Coulomb friction: docs/float-form.md,
// "Contact". The including pass declares READS(real4, substeps) and includes dot.glsl (dot3) first.

#include "respond.glsl"

// Where the path p0 → p1 through a sphere's frame first meets its surface, if it went deeper than 1 % of
// the reach; else p1. Shallower chords are particles sliding round the sphere.
real3 sphere_stop(real3 p0, real3 p1, real reach, out bool hit, out bool entered) {
  entered = false;
  precise real3 D = p1 - p0;
  precise real m = real(99.0) / real(100.0) * reach;
  precise real m2 = m * m;
  precise real a = dot3(D, D);
  precise real b = dot3(p0, D);
  precise real c0 = dot3(p0, p0);
  precise real c1 = dot3(p1, p1);
  precise real r2 = reach * reach;
  hit = c1 < r2;
  if (b < 0.0 && c0 >= m2) {
    precise real b2 = b * b;
    precise real nearest = c1;  // squared distance of the path's nearest point: its end, or where it passed
    if (dot3(p1, D) > 0.0) {
      precise real advance = b2 / a;
      nearest = c0 - advance;
    }
    if (nearest < m2) {
      precise real beyond = c0 - r2;
      beyond = a * beyond;
      precise real k = b2 - beyond;
      precise real root = sqrt(max(k, 0.0));
      precise real tau = -b - root;
      tau = tau / a;
      tau = max(tau, 0.0);
      precise real3 travelled = tau * D;
      precise real3 e = p0 + travelled;
      hit = true;
      entered = true;
      return e;
    }
  }
  return p1;
}

// A sphere's rows of the table: where it is at the substep's end and its reach, how far it came and its
// friction, and its velocity.
struct SphereRows {
  real4 place, travel, velocity;
};

SphereRows sphere_rows(uint row, uint s) {
  uint at = row + kRowHeadVec4s + s * kRowSphereVec4s;
  return SphereRows(substeps[at], substeps[at + 1u], substeps[at + 2u]);
}

// One or two spheres are read once an invocation by hold_spheres(), for the reason of held_params.glsl,
// and cost no loop, which would cost a software device its registers. step_of() calls it.
const bool spheres = sphere_number != 0u, few_spheres = sphere_number <= 2u;
SphereRows held_spheres[2];
#define HOLDS_SPHERES

// Kernels that march with many rows in registers have none to spare for a loop over spheres: they ask of each
// drift whether it ends in a box round all of them, and look at those that do once the strip is done.
#ifdef LATE_SPHERES
const bool late_spheres = !few_spheres;
vec3 spheres_low, spheres_high;  // corners of that box
float spheres_leap2;             // square of the drift up to which no path that ends outside touches one [m²]

// A path that ends outside has its end farther from a sphere's centre than its reach and its own length, as
// the sphere sees it, and 1 % of both and rounding besides: sphere_contact() would do nothing.
void hold_sphere_box(uint row) {
  float leap = 0.25 * sphere_rows(row, 0u).place.w;
  spheres_leap2 = 0.999 * leap * leap;
  spheres_low = vec3(1e30);
  spheres_high = vec3(-1e30);
  for (uint s = 0u; s < params.sphere_count; ++s) {
    SphereRows rows_of = sphere_rows(row, s);
    vec3 center = rows_of.place.xyz;
    float travel = length(rows_of.travel.xyz), place = length(center) + travel;
    float beyond = 1.01 * (rows_of.place.w + leap + travel) + 1e-5 * place;
    spheres_low = min(spheres_low, center - beyond);
    spheres_high = max(spheres_high, center + beyond);
  }
}

bool may_touch_sphere(vec3 x0, vec3 x1) {
  vec3 moved = x1 - x0;
  bool inside = all(greaterThan(x1, spheres_low)) && all(lessThan(x1, spheres_high));
  return inside || !(dot(moved, moved) < spheres_leap2);
}
#else
const bool late_spheres = false;
#endif

void hold_spheres(uint row) {
#ifdef LATE_SPHERES
  if (late_spheres) hold_sphere_box(row);
#endif
  if (!few_spheres) return;
  if (sphere_number > 0u) held_spheres[0] = sphere_rows(row, 0u);
  if (sphere_number > 1u) held_spheres[1] = sphere_rows(row, 1u);
}

void sphere_contact(SphereRows rows_of, real3 x0, inout real3 x1, inout real3 v) {
  real4 place = rows_of.place, travel = rows_of.travel;
  precise real3 p0 = x0 - (place.xyz - travel.xyz);
  precise real3 p1 = x1 - place.xyz;
  bool hit, entered;
  precise real3 e = sphere_stop(p0, p1, place.w, hit, entered);
  if (!hit) return;
  precise real l = sqrt(dot3(e, e));
  precise real3 n = real3(0.0, 1.0, 0.0);
  if (l > kNoLength) {
    precise real inverse = 1.0 / l;
    n = e * inverse;
  }
  precise real3 out_to = place.w * n;
  if (entered) {  // it goes on along the tangent plane
    precise real3 beyond = p1 - out_to;
    precise real3 up = dot3(beyond, n) * n;
    out_to = p1 - up;
  }
  precise real3 stopped = place.xyz + out_to;
  x1 = stopped;
  v = respond(v, rows_of.velocity.xyz, n, travel.w);
}

// The floor alone.
void touch_floor(inout real3 x1, inout real3 v) {
  if (floor_contact && x1.y < params.floor_height_m) {
    x1.y = params.floor_height_m;
    v = respond(v, real3(0.0), real3(0.0, 1.0, 0.0), params.floor_friction);
  }
}

// Spheres in scene order, then the floor, so that the floor always holds. `row` starts the dispatch's row,
// for which hold_spheres() was called.
void contact(uint row, real3 x0, inout real3 x1, inout real3 v) {
  if (!few_spheres)
    for (uint s = 0u; s < params.sphere_count; ++s) sphere_contact(sphere_rows(row, s), x0, x1, v);
  if (few_spheres && sphere_number > 0u) sphere_contact(held_spheres[0], x0, x1, v);
  if (few_spheres && sphere_number > 1u) sphere_contact(held_spheres[1], x0, x1, v);
  touch_floor(x1, v);
}
