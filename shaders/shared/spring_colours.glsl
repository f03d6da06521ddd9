// Colours of springs: those of a colour share no particle. docs/solvers.md "xpbd". An item is a kind and one
// of its two colours; each invocation has one spring.

#include "sheets.glsl"

const uint kStructuralI = 0u, kStructuralJ = 1u, kShearUp = 3u, kFlexI = 4u, kFlexJ = 5u;

struct Spring {
  uint kind, i, j, a, b;  // named by (i, j) of its cloth; a and b are its ends
};

// The n-th place of a colour where two of every four belong to it: 0 1 4 5 ..., 2 3 6 7 ...
uint pair_of_two(uint n, uint colour) { return (n / 2u) * 4u + colour * 2u + n % 2u; }

// This invocation's spring; false beyond the last.
bool coloured_spring(uint item, out Spring s) {
  uint colour = item % 2u, nx = params.nx, ny = rows_of_cloth(), first = 0u;
  s.kind = item / 2u;
  s.i = gl_GlobalInvocationID.x;
  s.j = gl_GlobalInvocationID.y;
  uvec2 reach = uvec2(1u, 1u);
  if (s.kind == kStructuralI) reach = uvec2(1u, 0u);
  if (s.kind == kStructuralJ) reach = uvec2(0u, 1u);
  if (s.kind == kFlexI) reach = uvec2(2u, 0u);
  if (s.kind == kFlexJ) reach = uvec2(0u, 2u);
  if (sheet_rows != 0u) {  // as many lanes as one cloth alone would have, then the next one's
    uint lanes = ny;
    if (s.kind == kStructuralJ) lanes = (ny + 1u) / 2u;
    if (s.kind == kFlexJ) lanes = (ny + 3u) / 4u * 2u;
    first = s.j / lanes * ny;
    s.j = s.j % lanes;
  }
  if (s.kind == kStructuralJ)
    s.j = 2u * s.j + colour;
  else if (s.kind == kFlexI)
    s.i = pair_of_two(s.i, colour);
  else if (s.kind == kFlexJ)
    s.j = pair_of_two(s.j, colour);
  else
    s.i = 2u * s.i + colour;
  if (s.i + reach.x >= nx || s.j + reach.y >= ny) return false;
  uint own = (first + s.j) * nx + s.i;
  bool rising = s.kind == kShearUp;
  s.a = rising ? own + 1u : own;
  s.b = rising ? own + nx : own + reach.y * nx + reach.x;
  return true;
}
