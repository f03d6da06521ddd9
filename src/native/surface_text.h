// Vertex normals of a vector of particles as docs/float-form.md "Vertex normals", and the vec4s that are
// drawn. Included by kernel_text.h.

/// The positions around a vector of particles; a row that does not exist is never used.
struct Around {
  const float *above, *own, *below;
  Index stride;
  WEFT_INLINE Vec3 at(const float* row, int columns) const { return load3(row + columns, stride); }
};

/// Triangles A = (i,j) (i,j+1) (i+1,j) and B = (i+1,j) (i,j+1) (i+1,j+1) of the four cells, in their order.
WEFT_INLINE Vec3 normal_sum(const Around& p, Mask has_left, Mask has_right, bool has_above, bool has_below) {
  const Vec3 own = p.at(p.own, 0), left = p.at(p.own, -1), right = p.at(p.own, 1);
  Vec3 sum{};
  if (has_below) {
    const Vec3 below = p.at(p.below, 0), below_left = p.at(p.below, -1);
    sum = select(has_right, sum + triangle(own, below, right), sum);
    sum = select(has_left, (sum + triangle(own, below_left, below)) + triangle(left, below_left, own), sum);
  }
  if (has_above) {
    const Vec3 above = p.at(p.above, 0), above_right = p.at(p.above, 1);
    sum =
        select(has_right, (sum + triangle(above_right, own, right)) + triangle(above, own, above_right), sum);
    sum = select(has_left, sum + triangle(above, left, own), sum);
  }
  return sum;
}

WEFT_INLINE Vec3 unit(Vec3 n) {
  const Vec l = root(dot(n, n));
  return select(l > splat(kNoNormal), (splat(1.0f) / l) * n, Vec3{});
}

/// `count` lanes as vec4s.
WEFT_INLINE void write_vec4(float* to, Index count, Vec3 v, const float* w) {
  for (Index lane = 0; lane < count; ++lane) {
    to[4 * lane] = v.x[lane];
    to[4 * lane + 1] = v.y[lane];
    to[4 * lane + 2] = v.z[lane];
    to[4 * lane + 3] = w == nullptr ? 0.0f : w[lane];
  }
}

void surface(const Surface& s) {
  for (Index j = s.first; j < s.last; ++j) {
    const bool has_above = j > 0, has_below = j + 1 < s.ny;
    for (Index i = 0; i < s.nx; i += kLanes) {
      const Index column = kColumns + i, particle = j * s.nx + i;
      Mask has_left{}, has_right{};
      for (int lane = 0; lane < kLanes; ++lane) {
        has_left[lane] = i + lane > 0 ? -1 : 0;
        has_right[lane] = i + lane + 1 < s.nx ? -1 : 0;
      }
      const Around around{s.rows[has_above ? j - 1 : j] + column, s.rows[j] + column, s.rows[j + 1] + column,
                          s.stride};
      const Index count = s.nx - i < kLanes ? s.nx - i : kLanes;
      if (s.normal != nullptr) {
        const Vec3 n = unit(normal_sum(around, has_left, has_right, has_above, has_below));
        write_vec4(s.normal + 4 * particle, count, n, nullptr);
      }
      write_vec4(s.position + 4 * particle, count, around.at(around.own, 0),
                 s.relative_inverse_mass + particle);
      if (s.velocity != nullptr)
        write_vec4(s.velocity + 4 * particle, count, load3(s.rows[j] + column + 3 * s.stride, s.stride),
                   nullptr);
    }
  }
}

void write_places(const PlaceRows& to) {
  for (Index j = to.first; j < to.last; ++j)
    for (Index i = 0; i < to.nx; i += kLanes)
      write_vec4(to.places + 4 * (j * to.nx + i), to.nx - i < kLanes ? to.nx - i : kLanes,
                 load3(to.rows[j] + kColumns + i, to.stride), nullptr);
}
