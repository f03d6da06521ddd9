// Whether a piece of the cloth is so little bent that what is apart on it is apart in space. The including
// pass declares `position` and includes cells.glsl and dot.glsl first. Source: docs/effects.md "Self-
// collision".

// The greatest stretch of a triangle with these two edges, times a cell's edge.
real greatest_stretch(real3 along, real3 down) {
  real p = dot3(along, along), s = dot3(down, down), m = dot3(along, down);
  precise real middle = 0.5 * (p + s), half_off = 0.5 * (p - s);
  precise real greatest = sqrt(middle + sqrt(half_off * half_off + m * m));
  return greatest;
}

// Whether a triangle with these edges takes every direction on the cloth to one that goes on by `least`,
// times a cell's edge, or more where the reference takes it: the symmetric part of one map's transpose
// times the other, less `least`, has no negative eigenvalue.
bool goes_along(real3 reference_i, real3 reference_j, real least, real3 edge_i, real3 edge_j) {
  precise real a = dot3(reference_i, edge_i) - least, b = dot3(reference_j, edge_j) - least;
  precise real m = 0.5 * (dot3(reference_i, edge_j) + dot3(reference_j, edge_i));
  precise real off = m * m, both = a * b;
  return a >= 0.0 && b >= 0.0 && both >= off;
}

// Whether all triangles between the particles low and high (columns and rows) go along with these two edges
// so far that points of theirs are at least `stretch` times as far apart as on the cloth, in cells.
bool nearly_flat(Cells c, uvec2 low, uvec2 high, real3 along, real3 down, real stretch) {
  precise real least = stretch * greatest_stretch(along, down);
  bool flat_so_far = true;
  for (uint i = low.x; i < high.x && flat_so_far; ++i) {
    uint p = low.y * c.nx + i;
    real3 here = position[p].xyz, right = position[p + 1u].xyz;
    for (uint j = low.y; j < high.y; ++j) {
      p += c.nx;
      real3 below = position[p].xyz, across = position[p + 1u].xyz;
      precise real3 top = right - here, left = below - here, bottom = across - below, far = across - right;
      flat_so_far = flat_so_far && goes_along(along, down, least, top, left) &&
                    goes_along(along, down, least, bottom, far);
      here = below;
      right = across;
    }
  }
  return flat_so_far;
}
