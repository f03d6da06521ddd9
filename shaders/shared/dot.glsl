// The one dot product: docs/float-form.md.
float dot3(vec3 a, vec3 b) {
  precise float sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
  return sum;
}
