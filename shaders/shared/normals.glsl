// The body of normals.comp and of normals_torn.comp, which defines TORN.

READS (real4, position)
WRITES(real4, normal)

layout(local_size_x = 64) in;

#include "sheets.glsl"
#include "whole_triangles.glsl"

real3 cross_of(real3 p, real3 q, real3 r) {
  precise real3 a = q - p;
  precise real3 b = r - p;
  precise real3 n = real3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return n;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, nx = params.nx, ny = params.ny;
  if (i >= nx || j >= ny) return;
  uint p = j * nx + i, row = own_row(j);
  bool left = i >= 1u, right = i + 1u < nx, up = row >= 1u, down = row + 1u < rows_of_cloth();
  real3 own = position[p].xyz;
  real3 east = position[right ? p + 1u : p].xyz;
  real3 west = position[left ? p - 1u : p].xyz;
  real3 north = position[up ? p - nx : p].xyz;
  real3 south = position[down ? p + nx : p].xyz;
  real3 north_east = position[up && right ? p - nx + 1u : p].xyz;
  real3 south_west = position[down && left ? p + nx - 1u : p].xyz;

  precise real3 n = real3(0.0);
  if (right && down && whole_a(p)) n = n + cross_of(own, south, east);  // A(i, j)
  if (left && down && whole_b(p - 1u)) n = n + cross_of(own, south_west, south);  // B(i-1, j)
  if (left && down && whole_a(p - 1u)) n = n + cross_of(west, south_west, own);  // A(i-1, j)
  if (up && right && whole_b(p - nx)) n = n + cross_of(north_east, own, east);  // B(i, j-1)
  if (up && right && whole_a(p - nx)) n = n + cross_of(north, own, north_east);  // A(i, j-1)
  if (up && left && whole_b(p - nx - 1u)) n = n + cross_of(north, west, own);  // B(i-1, j-1)

  precise real q = (n.x * n.x + n.y * n.y) + n.z * n.z;
  precise real l = sqrt(q);
  precise real3 unit = real3(0.0);
  if (l > kNoNormal) {
    precise real inverse = 1.0 / l;
    unit = n * inverse;
  }
  normal[p] = real4(unit, 0.0);
}
