// The springs' force on one particle, gathered over its 12 neighbours in the order of docs/float-form.md.
// The including pass declares READS(vec4, position) and READS(vec4, velocity) first.

float dot3(vec3 a, vec3 b) {
  precise float sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
  return sum;
}

// One end of a pair.
struct End {
  vec3 x, v;
};

// A pair that does not exist is asked for at the particle itself: always a valid address, and with
// coefficients of zero its force is zero.
End end_at(uint particle) {
  End end;
  end.x = position[particle].xyz;
  end.v = damping ? velocity[particle].xyz : vec3(0.0);
  return end;
}

// Force [N] on a of the pair a, b; k = (K, L, c).
vec3 pair_force(vec3 k, End a, End b) {
  precise vec3 d = b.x - a.x;
  precise float q = max(dot3(d, d), kTinyLengthSquared);
  precise float root = sqrt(q);
  precise float r = 1.0 / root;
  precise float s;
  if (damping) {
    precise vec3 dv = b.v - a.v;
    precise float t = k.z * dot3(d, dv);
    t = t * r;
    t = t - k.y;
    t = t * r;
    s = t + k.x;
  } else {
    precise float t = k.y * r;
    s = k.x - t;
  }
  precise vec3 f = s * d;
  return f;
}

// Row of params.structural for a pair along a line of `count` particles whose first end is at `first`.
// Chosen by comparisons of uniform loads: a row index that differs between lanes would be a gather.
vec3 structural_row(uint direction, bool boundary, uint first, uint count) {
  uint base = direction * 6u;
  if (!bending) return boundary ? params.structural[base + 3u].xyz : params.structural[base].xyz;
  bool before = first >= 1u, after = first + 2u < count;
  vec3 none = boundary ? params.structural[base + 3u].xyz : params.structural[base].xyz;
  vec3 one = boundary ? params.structural[base + 4u].xyz : params.structural[base + 1u].xyz;
  vec3 two = boundary ? params.structural[base + 5u].xyz : params.structural[base + 2u].xyz;
  return before && after ? two : (before || after ? one : none);
}

vec3 flex_row(uint direction, bool boundary) {
  return boundary ? params.flex[direction * 2u + 1u].xyz : params.flex[direction * 2u].xyz;
}

// The sum of all pairs' forces [N] at particle (i, j), whose own end is `own`.
vec3 spring_force(uint i, uint j, uint p, End own) {
  const bool far_pairs = flex || bending;  // (2,0)-type pairs carry flex springs and folded bending
  uint nx = params.nx, ny = params.ny;
  bool left = i >= 1u, right = i + 1u < nx, up = j >= 1u, down = j + 1u < ny;
  bool row_edge = !up || !down, column_edge = !left || !right;

  precise vec3 P = vec3(0.0);
  if (far_pairs) {
    bool there = j >= 2u;
    P = pair_force(there ? flex_row(1u, column_edge) : vec3(0.0), end_at(there ? p - 2u * nx : p), own);
  }
  P = P + pair_force(up ? structural_row(1u, column_edge, j - 1u, ny) : vec3(0.0),
                     end_at(up ? p - nx : p), own);
  if (shear) {
    bool there = up && right;
    P = P + pair_force(there ? params.shear.xyz : vec3(0.0), end_at(there ? p - nx + 1u : p), own);
    there = up && left;
    P = P + pair_force(there ? params.shear.xyz : vec3(0.0), end_at(there ? p - nx - 1u : p), own);
  }

  precise vec3 F = pair_force(down ? structural_row(1u, column_edge, j, ny) : vec3(0.0), own,
                              end_at(down ? p + nx : p)) - P;
  F = F + pair_force(right ? structural_row(0u, row_edge, i, nx) : vec3(0.0), own, end_at(right ? p + 1u : p));
  precise vec3 f10 = pair_force(left ? structural_row(0u, row_edge, i - 1u, nx) : vec3(0.0),
                                end_at(left ? p - 1u : p), own);
  if (shear) {
    bool there = left && down;
    precise vec3 difference =
        pair_force(there ? params.shear.xyz : vec3(0.0), own, end_at(there ? p + nx - 1u : p)) - f10;
    F = F + difference;
    there = right && down;
    F = F + pair_force(there ? params.shear.xyz : vec3(0.0), own, end_at(there ? p + nx + 1u : p));
  } else {
    F = F - f10;
  }
  if (far_pairs) {
    bool there = i + 2u < nx;
    F = F + pair_force(there ? flex_row(0u, row_edge) : vec3(0.0), own, end_at(there ? p + 2u : p));
    there = i >= 2u;
    F = F - pair_force(there ? flex_row(0u, row_edge) : vec3(0.0), end_at(there ? p - 2u : p), own);
    there = j + 2u < ny;
    F = F + pair_force(there ? flex_row(1u, column_edge) : vec3(0.0), own, end_at(there ? p + 2u * nx : p));
  }
  return F;
}
