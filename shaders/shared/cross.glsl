// The one cross product: docs/float-form.md, each component as product minus product.
real3 cross3(real3 a, real3 b) {
  precise real x = a.y * b.z - a.z * b.y;
  precise real y = a.z * b.x - a.x * b.z;
  precise real z = a.x * b.y - a.y * b.x;
  return real3(x, y, z);
}
