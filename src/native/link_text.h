// How long links are, how fast particles, a vector of them at a time. Included by kernel_text.h.

/// What is no number counts nowhere: no limit is below it.
void look_at_links(LinkLook& look) {
  Vec structural{}, shear{}, speed{}, place{};
  for (Index j = look.first; j < look.last; ++j) {
    const float *const row = look.rows[j] + kColumns, *const next = look.rows[j + 1] + kColumns;
    for (Index i = 0; i < look.nx; i += kLanes) {
      const Mask lanes = lanes_from(static_cast<int>(i));
      const Mask has_own = lanes < static_cast<int>(look.nx),
                 has_right = lanes + 1 < static_cast<int>(look.nx);
      const auto longest = [](Vec& most, Vec3 a, Vec3 b, Mask exists) {
        const Vec3 d = b - a;
        most = larger(select(exists, dot(d, d), Vec{}), most);
      };
      const Vec3 own = load3(row + i, look.stride), v = load3(row + i + 3 * look.stride, look.stride);
      const Vec3 right = load3(row + i + 1, look.stride);
      longest(structural, own, right, has_right);
      speed = larger(select(has_own, dot(v, v), Vec{}), speed);
      place = larger(select(has_own, dot(own, own), Vec{}), place);
      if (j + 1 == look.ny) continue;
      const Vec3 below = load3(next + i, look.stride), across = load3(next + i + 1, look.stride);
      longest(structural, own, below, has_own);
      longest(shear, own, across, has_right);
      longest(shear, right, below, has_right);
    }
  }
  look.structural2 = largest(structural);
  look.shear2 = largest(shear);
  look.speed2 = largest(speed);
  look.place2 = largest(place);
}
