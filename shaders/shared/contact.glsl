// Contact of one particle with the spheres and the floor, swept, with Coulomb friction: docs/float-form.md,
// "Contact". The including pass declares READS(vec4, substeps) and includes dot.glsl (dot3) first.

// Takes away the inward normal velocity relative to the collider, and friction from the rest.
vec3 respond(vec3 v, vec3 collider_velocity, vec3 n, float friction) {
  precise vec3 u = v - collider_velocity;
  precise float un = dot3(u, n);
  if (un >= 0.0) return v;
  precise vec3 along = un * n;
  precise vec3 t = u - along;
  precise float lt = sqrt(dot3(t, t));
  precise float cut = friction * (-un);
  precise float keep = 0.0;
  if (lt > cut) {
    precise float share = cut / lt;
    keep = 1.0 - share;
  }
  precise vec3 kept = keep * t;
  precise vec3 answer = collider_velocity + kept;
  return answer;
}

// Where the path p0 → p1 through a sphere's frame first meets its surface, if it went deeper than 1 % of the
// reach; else p1. Shallower chords are particles sliding round the sphere.
vec3 sphere_stop(vec3 p0, vec3 p1, float reach, out bool hit) {
  precise vec3 D = p1 - p0;
  precise float m = 0.99 * reach;
  precise float m2 = m * m;
  precise float a = dot3(D, D);
  precise float b = dot3(p0, D);
  precise float c0 = dot3(p0, p0);
  precise float c1 = dot3(p1, p1);
  precise float r2 = reach * reach;
  hit = c1 < r2;
  if (b < 0.0 && c0 >= m2) {
    precise float b2 = b * b;
    precise float nearest = c1;  // squared distance of the path's nearest point: its end, or where it passed
    if (dot3(p1, D) > 0.0) {
      precise float advance = b2 / a;
      nearest = c0 - advance;
    }
    if (nearest < m2) {
      precise float beyond = c0 - r2;
      beyond = a * beyond;
      precise float k = b2 - beyond;
      precise float root = sqrt(max(k, 0.0));
      precise float tau = -b - root;
      tau = tau / a;
      tau = max(tau, 0.0);
      precise vec3 travelled = tau * D;
      precise vec3 e = p0 + travelled;
      hit = true;
      return e;
    }
  }
  return p1;
}

void sphere_contact(uint row, vec3 x0, inout vec3 x1, inout vec3 v) {
  vec4 place = substeps[row];
  vec4 travel = substeps[row + 1u];
  precise vec3 p0 = x0 - (place.xyz - travel.xyz);
  precise vec3 p1 = x1 - place.xyz;
  bool hit;
  precise vec3 e = sphere_stop(p0, p1, place.w, hit);
  if (!hit) return;
  precise float l = sqrt(dot3(e, e));
  precise vec3 n = vec3(0.0, 1.0, 0.0);
  if (l > 1e-12) {
    precise float inverse = 1.0 / l;
    n = e * inverse;
  }
  precise vec3 out_to = place.w * n;
  precise vec3 stopped = place.xyz + out_to;
  x1 = stopped;
  v = respond(v, substeps[row + 2u].xyz, n, travel.w);
}

// Spheres in scene order, then the floor, so that the floor always holds. `row` starts the dispatch's row.
void contact(uint row, vec3 x0, inout vec3 x1, inout vec3 v) {
  if (spheres)
    for (uint s = 0u; s < params.sphere_count; ++s)
      sphere_contact(row + kRowHeadVec4s + s * kRowSphereVec4s, x0, x1, v);
  if (floor_contact && x1.y < params.floor_height_m) {
    x1.y = params.floor_height_m;
    v = respond(v, vec3(0.0), vec3(0.0, 1.0, 0.0), params.floor_friction);
  }
}
