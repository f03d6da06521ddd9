// The springs' force on a particle, gathered over its 12 neighbours in the order of docs/float-form.md,
// marching down a column of particles so that what one row loaded and computed serves the rows below. The
// including pass declares READS(real4, position) and READS(real4, velocity) first, or defines both macros
// below.
#ifndef SOURCE_POSITION
#define SOURCE_POSITION(particle) position[particle]
#define SOURCE_VELOCITY(particle) velocity[particle]
#endif

#include "dot.glsl"
#include "sheets.glsl"

// One end of a pair.
struct End {
  real3 x, v;
};

// A pair that does not exist is asked for at the particle itself: always a valid address, and with
// coefficients of zero its force is zero.
End end_at(uint particle) {
  End end;
  end.x = SOURCE_POSITION(particle).xyz;
  end.v = damping ? SOURCE_VELOCITY(particle).xyz : real3(0.0);
  return end;
}

// Force [N] on a of the pair a, b; k = (K, L, c).
real3 pair_force(real3 k, End a, End b) {
  precise real3 d = b.x - a.x;
  precise real q = max(dot3(d, d), kTinyLengthSquared);
  precise real root = sqrt(q);
  precise real r = 1.0 / root;
  precise real s;
  if (damping) {
    precise real3 dv = b.v - a.v;
    precise real t = k.z * dot3(d, dv);
    t = t * r;
    t = t - k.y;
    t = t * r;
    s = t + k.x;
  } else {
    precise real t = k.y * r;
    s = k.x - t;
  }
  precise real3 f = s * d;
  return f;
}

// Coefficients (K, L, c) of every pair a column of particles has, read once. Chosen by comparisons of uniform
// loads: an index that differs between lanes would be a gather.
struct Column {
  uint nx, ny, i;
  bool left, right, left2, right2;      // whether there are neighbours one and two columns away
  real3 down_none, down_one, down_two;   // f01 that 0, 1, 2 bending triples lean on
  real3 right_inner, right_edge;         // f10(i, j) inside and on the first and last row
  real3 left_inner, left_edge;           // f10(i-1, j)
  real3 right2_inner, right2_edge;       // f20(i, j)
  real3 left2_inner, left2_edge;         // f20(i-2, j)
  real3 down2;                           // f02
  real3 shear_left, shear_right;
};

// Row of params.structural along i for the pair whose first particle is at column `first`.
real3 row_along_i(uint first, bool boundary, uint nx) {
  real3 none = boundary ? params.structural[3].xyz : params.structural[0].xyz;
  if (!bending) return none;
  real3 one = boundary ? params.structural[4].xyz : params.structural[1].xyz;
  real3 two = boundary ? params.structural[5].xyz : params.structural[2].xyz;
  bool before = first >= 1u, after = first + 2u < nx;
  return before && after ? two : (before || after ? one : none);
}

Column column_at(uint i) {
  const real3 absent = real3(0.0);
  Column c;
  c.nx = params.nx;
  c.ny = rows_of_cloth();
  c.i = i;
  c.left = i >= 1u;
  c.right = i + 1u < c.nx;
  c.left2 = i >= 2u;
  c.right2 = i + 2u < c.nx;
  bool edge = !c.left || !c.right;
  c.down_none = edge ? params.structural[9].xyz : params.structural[6].xyz;
  c.down_one = edge ? params.structural[10].xyz : params.structural[7].xyz;
  c.down_two = edge ? params.structural[11].xyz : params.structural[8].xyz;
  c.right_inner = c.right ? row_along_i(i, false, c.nx) : absent;
  c.right_edge = c.right ? row_along_i(i, true, c.nx) : absent;
  c.left_inner = c.left ? row_along_i(i - 1u, false, c.nx) : absent;
  c.left_edge = c.left ? row_along_i(i - 1u, true, c.nx) : absent;
  c.right2_inner = c.right2 ? params.flex[0].xyz : absent;
  c.right2_edge = c.right2 ? params.flex[1].xyz : absent;
  c.left2_inner = c.left2 ? params.flex[0].xyz : absent;
  c.left2_edge = c.left2 ? params.flex[1].xyz : absent;
  c.down2 = edge ? params.flex[3].xyz : params.flex[2].xyz;
  c.shear_left = c.left ? params.shear.xyz : absent;
  c.shear_right = c.right ? params.shear.xyz : absent;
  return c;
}

// What marching down a column carries from row to row: the particles that the next rows meet again, and the
// forces already known. Named by their offset from the row's own particle.
struct March {
  uint j, p;  // the row within its own cloth; the particle
  End own, down1, down2;  // (i, j), (i, j+1), (i, j+2)
  End left_up, left, left_down, right_up, right, right_down;
  real3 f01_up, f02_up1, f02_up2;  // f01(i, j-1), f02(i, j-1), f02(i, j-2)
};

// f01 of the particle at row j, between its end a and the one below.
real3 f01_of(Column c, uint j, End a, End b) {
  real3 k = c.down_none;
  if (bending) {
    bool before = j >= 1u, after = j + 2u < c.ny;
    k = before && after ? c.down_two : (before || after ? c.down_one : c.down_none);
  }
  return pair_force(j + 1u < c.ny ? k : real3(0.0), a, b);
}

real3 f02_of(Column c, uint j, End a, End b) {
  return pair_force(j + 2u < c.ny ? c.down2 : real3(0.0), a, b);
}

// Loads everything that a row, counted through all cloths, needs and that the march does not load row by row.
March march_from(Column c, uint row) {
  const bool far_pairs = flex || bending;  // (2,0)-type pairs carry flex springs and folded bending
  const End nothing = End(real3(0.0), real3(0.0));
  March m;
  uint j = own_row(row);
  m.j = j;
  m.p = row * c.nx + c.i;
  bool up = j >= 1u, up2 = j >= 2u;
  m.own = end_at(m.p);
  End up1 = end_at(up ? m.p - c.nx : m.p);
  m.down1 = end_at(j + 1u < c.ny ? m.p + c.nx : m.p);
  m.left = end_at(c.left ? m.p - 1u : m.p);
  m.right = end_at(c.right ? m.p + 1u : m.p);
  m.left_up = shear ? end_at(up && c.left ? m.p - c.nx - 1u : m.p) : nothing;
  m.right_up = shear ? end_at(up && c.right ? m.p - c.nx + 1u : m.p) : nothing;
  m.down2 = m.left_down = m.right_down = nothing;
  m.f01_up = up ? f01_of(c, j - 1u, up1, m.own) : real3(0.0);
  m.f02_up1 = m.f02_up2 = real3(0.0);
  if (far_pairs) {
    if (up2) m.f02_up2 = f02_of(c, j - 2u, end_at(m.p - 2u * c.nx), m.own);
    if (up) m.f02_up1 = f02_of(c, j - 1u, up1, m.down1);
  }
  return m;
}

// The sum of all pairs' forces [N] at the march's particle.
real3 spring_force(Column c, inout March m) {
  const bool far_pairs = flex || bending;
  const real3 absent = real3(0.0);
  uint p = m.p;
  bool up = m.j >= 1u, down = m.j + 1u < c.ny, edge = !up || !down;

  precise real3 P = real3(0.0);
  if (far_pairs) P = m.f02_up2;
  P = P + m.f01_up;
  if (shear) {
    P = P + pair_force(up ? c.shear_right : absent, m.right_up, m.own);
    P = P + pair_force(up ? c.shear_left : absent, m.left_up, m.own);
  }

#ifdef WEFT_REACH
  look_at_link(m.own.x, m.down1.x, false);
  look_at_link(m.own.x, m.right.x, false);
#endif
  m.f01_up = f01_of(c, m.j, m.own, m.down1);  // what the next row calls f01(i, j-1)
  precise real3 F = m.f01_up - P;
  F = F + pair_force(edge ? c.right_edge : c.right_inner, m.own, m.right);
  precise real3 f10 = pair_force(edge ? c.left_edge : c.left_inner, m.left, m.own);
  if (shear) {
    m.left_down = end_at(down && c.left ? p + c.nx - 1u : p);
    precise real3 difference = pair_force(down ? c.shear_left : absent, m.own, m.left_down) - f10;
    F = F + difference;
    m.right_down = end_at(down && c.right ? p + c.nx + 1u : p);
    F = F + pair_force(down ? c.shear_right : absent, m.own, m.right_down);
#ifdef WEFT_REACH
    look_at_link(m.own.x, m.left_down.x, true);
    look_at_link(m.own.x, m.right_down.x, true);
#endif
  } else {
    F = F - f10;
  }
  if (far_pairs) {
    F = F + pair_force(edge ? c.right2_edge : c.right2_inner, m.own, end_at(c.right2 ? p + 2u : p));
    F = F - pair_force(edge ? c.left2_edge : c.left2_inner, end_at(c.left2 ? p - 2u : p), m.own);
    m.down2 = end_at(m.j + 2u < c.ny ? p + 2u * c.nx : p);
    m.f02_up2 = m.f02_up1;
    m.f02_up1 = f02_of(c, m.j, m.own, m.down2);
    F = F + m.f02_up1;
  }
  return F;
}

// Moves the march to the next row.
void step_down(Column c, inout March m) {
  ++m.j;
  m.p += c.nx;
  m.own = m.down1;
  if (flex || bending)
    m.down1 = m.down2;
  else
    m.down1 = end_at(m.j + 1u < c.ny ? m.p + c.nx : m.p);
  if (shear) {
    m.left_up = m.left;
    m.right_up = m.right;
    m.left = m.left_down;
    m.right = m.right_down;
  } else {
    m.left = end_at(c.left ? m.p - 1u : m.p);
    m.right = end_at(c.right ? m.p + 1u : m.p);
  }
}
