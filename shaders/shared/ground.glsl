// The floor after the other contacts, level or tilted: docs/float-form.md, "Contact". The including pass
// includes dot.glsl and respond.glsl first.

void level_touch(inout real3 x1, inout real3 v) {
  if (!(x1.y < params.floor_height_m)) return;
  x1.y = params.floor_height_m;
  v = respond(v, real3(0.0), real3(0.0, 1.0, 0.0), params.floor_friction);
}

// plane: normal, and what normal·x is on it.
void tilted_touch(real4 plane, inout real3 x1, inout real3 v) {
  precise real d = dot3(plane.xyz, x1) - plane.w;
  if (!(d < 0.0)) return;
  precise real3 below = d * plane.xyz;
  precise real3 lifted = x1 - below;
  x1 = lifted;
  v = respond(v, real3(0.0), plane.xyz, params.floor_friction);
}
