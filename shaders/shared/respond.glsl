// What a contact leaves of a velocity: docs/float-form.md, "respond". The including pass includes dot.glsl
// first.

// Takes away the inward normal velocity relative to the collider, and friction from the rest.
real3 respond(real3 v, real3 collider_velocity, real3 n, real friction) {
  precise real3 u = v - collider_velocity;
  precise real un = dot3(u, n);
  if (un >= 0.0) return v;
  precise real3 along = un * n;
  precise real3 t = u - along;
  precise real lt = sqrt(dot3(t, t));
  precise real cut = friction * (-un);
  precise real keep = 0.0;
  if (lt > cut) {
    precise real share = cut / lt;
    keep = 1.0 - share;
  }
  precise real3 kept = keep * t;
  precise real3 answer = collider_velocity + kept;
  return answer;
}
