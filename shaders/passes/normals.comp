#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/pass.glsl"

// Vertex normals: the normalised sum of the unnormalised normals of the adjacent triangles.
// Each invocation gathers for its own vertex and writes only that: no races.
// Source: docs/float-form.md "Vertex normals".

READS (vec4, position)
WRITES(vec4, normal)

layout(local_size_x = 64) in;

vec3 cross_of(vec3 p, vec3 q, vec3 r) {
  precise vec3 a = q - p;
  precise vec3 b = r - p;
  precise vec3 n = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return n;
}

void main() {
  uint i = gl_GlobalInvocationID.x, j = gl_GlobalInvocationID.y, nx = params.nx, ny = params.ny;
  if (i >= nx || j >= ny) return;
  uint p = j * nx + i;
  bool left = i >= 1u, right = i + 1u < nx, up = j >= 1u, down = j + 1u < ny;
  vec3 own = position[p].xyz;
  vec3 east = position[right ? p + 1u : p].xyz;
  vec3 west = position[left ? p - 1u : p].xyz;
  vec3 north = position[up ? p - nx : p].xyz;
  vec3 south = position[down ? p + nx : p].xyz;
  vec3 north_east = position[up && right ? p - nx + 1u : p].xyz;
  vec3 south_west = position[down && left ? p + nx - 1u : p].xyz;

  precise vec3 n = vec3(0.0);
  if (right && down) n = n + cross_of(own, south, east);                  // A(i, j)
  if (left && down) n = n + cross_of(own, south_west, south);             // B(i-1, j)
  if (left && down) n = n + cross_of(west, south_west, own);              // A(i-1, j)
  if (up && right) n = n + cross_of(north_east, own, east);               // B(i, j-1)
  if (up && right) n = n + cross_of(north, own, north_east);              // A(i, j-1)
  if (up && left) n = n + cross_of(north, west, own);                     // B(i-1, j-1)

  precise float q = (n.x * n.x + n.y * n.y) + n.z * n.z;
  precise float l = sqrt(q);
  precise vec3 unit = vec3(0.0);
  if (l > 1e-30) {
    precise float inverse = 1.0 / l;
    unit = n * inverse;
  }
  normal[p] = vec4(unit, 0.0);
}
