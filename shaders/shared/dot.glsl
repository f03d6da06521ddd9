// The one dot product: docs/float-form.md.
real dot3(real3 a, real3 b) {
  precise real sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
  return sum;
}
