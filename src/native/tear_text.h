// Links that are too long, a vector of particles at a time, as docs/float-form.md "Tearing". Included by
// kernel_text.h.

/// Marks what is longer than the limit, and apart from it what was not broken before.
WEFT_INLINE void mark_longer(Vec3 a, Vec3 b, Vec longest2, Mask exists, int bit, Mask& links, Mask& fresh) {
  const Vec3 d = b - a;
  const Mask broken = (dot(d, d) > longest2) & exists & bit;
  fresh = fresh | (broken & ~links);
  links = links | broken;
}

/// Returns whether anything broke.
std::uint32_t tear(const Tear& t) {
  Mask lanes{};
  for (int lane = 0; lane < kLanes; ++lane) lanes[lane] = lane;
  std::uint32_t torn = 0;
  for (Index j = t.first; j < t.last; ++j) {
    const float *const row = t.rows[j] + kColumns, *const next = t.rows[j + 1] + kColumns;
    for (Index i = 0; i < t.nx; i += kLanes) {
      const Mask has_own = (lanes + static_cast<int>(i)) < static_cast<int>(t.nx);
      const Mask has_right = (lanes + static_cast<int>(i) + 1) < static_cast<int>(t.nx);
      Mask links{}, fresh{};
      for (int lane = 0; lane < kLanes && i + lane < t.nx; ++lane)
        links[lane] = static_cast<int>(t.broken_links[j * t.nx + i + lane]);
      const Vec3 own = load3(row + i, t.stride), right = load3(row + i + 1, t.stride);
      const Vec structural = splat(t.structural), shear = splat(t.shear);
      mark_longer(own, right, structural, has_right, t.along_i, links, fresh);
      if (j + 1 < t.ny) {
        const Vec3 below = load3(next + i, t.stride), across = load3(next + i + 1, t.stride);
        mark_longer(own, below, structural, has_own, t.along_j, links, fresh);
        mark_longer(own, across, shear, has_right, t.falling, links, fresh);
        mark_longer(right, below, shear, has_right, t.rising, links, fresh);
      }
      if (!any(fresh != Mask{})) continue;
      torn = 1;
      for (int lane = 0; lane < kLanes && i + lane < t.nx; ++lane)
        t.broken_links[j * t.nx + i + lane] = static_cast<std::uint32_t>(links[lane]);
    }
  }
  return torn;
}
