// Who is out of its room, a vector of particles of a row at a time, as docs/float-form.md "Motion". Included
// by kernel_text.h.

/// The first three of `count` vec4s, the others 0.
WEFT_INLINE Vec3 load_vec4(const float* from, Index count) {
  alignas(64) float last[4 * kLanes] = {};
  if (count < kLanes) {
    __builtin_memcpy(last, from, 4 * count * sizeof(float));
    from = last;
  }
  const Vec a = load(from), b = load(from + kLanes), c = load(from + 2 * kLanes), d = load(from + 3 * kLanes);
  // Each vector has kLanes/4 particles: even elements of even elements are x, and so on.
  const Vec xz_ab = evens(a, b), xz_cd = evens(c, d), yw_ab = odds(a, b), yw_cd = odds(c, d);
  return {evens(xz_ab, xz_cd), evens(yw_ab, yw_cd), odds(xz_ab, xz_cd)};
}

/// Whether a motion is longer than its room.
WEFT_INLINE Mask is_out(Vec3 motion, Vec most) { return dot(motion, motion) > most * most; }

std::size_t look_at_motion(LeashLook& look) {
  const Vec3 with_lists = splat3(look.with_lists), with_contacts = splat3(look.with_contacts);
  const Vec far2 = splat(look.moved_squared_max), roam = splat(look.roam_max);
  Mask stale{};
  Index left_over = 0;
  for (Index j = look.first; j < look.last; ++j)
    for (Index i = 0; i < look.nx; i += kLanes) {
      const Index particle = j * look.nx + i, count = look.nx - i < kLanes ? look.nx - i : kLanes;
      const Mask own = lanes_from(0) < static_cast<int>(count);
      const Vec3 x = load3(look.rows[j] + kColumns + i, look.stride);
      const Vec3 gone = (x - load_vec4(look.built + 4 * particle, count)) - with_lists;
      stale = stale | (own & ~(dot(gone, gone) <= far2));
      Mask out = is_out(gone, roam), bounds{};
      Vec w{};
      __builtin_memcpy(&bounds, look.bounds + particle, count * sizeof(float));
      __builtin_memcpy(&w, look.relative_inverse_mass + particle, count * sizeof(float));
      const Mask bound = own & (bounds != static_cast<int>(look.no_bound));
      if (any(bound)) {
        const Vec distance = (Vec)bounds;
        const Vec room =
            distance * smaller(splat(1.0f), (splat(2.0f) * distance) / splat(look.surface_limit));
        const Vec3 since = (x - load_vec4(look.near + 4 * particle, count)) - with_contacts;
        out = out | (bound & is_out(since, splat(look.roam_share) * room));
      }
      for (unsigned lanes = bits_of(out & own & (w != Vec{})); lanes != 0; lanes &= lanes - 1)
        look.left_over[left_over++] =
            static_cast<std::uint32_t>(particle + static_cast<Index>(__builtin_ctz(lanes)));
    }
  look.stale = any(stale) ? 1 : 0;
  return left_over;
}

void measure_motion(MotionLook& look) {
  Mask unsound{};
  Vec most_gone{}, most_speed{}, most_place{};
  for (Index j = look.first; j < look.last; ++j)
    for (Index i = 0; i < look.nx; i += kLanes) {
      const Index count = look.nx - i < kLanes ? look.nx - i : kLanes;
      const Mask own = lanes_from(0) < static_cast<int>(count);
      const float* const at = look.rows[j] + kColumns + i;
      const Vec3 x = load3(at, look.stride), v = load3(at + 3 * look.stride, look.stride),
                 gone = x - load_vec4(look.built + 4 * (j * look.nx + i), count);
      const Vec gone2 = select(own, dot(gone, gone), Vec{}), speed2 = select(own, dot(v, v), Vec{}),
                place2 = select(own, dot(x, x), Vec{});
      unsound = unsound | ~(gone2 + speed2 + place2 < __builtin_inff());
      most_gone = larger(gone2, most_gone);
      most_speed = larger(speed2, most_speed);
      most_place = larger(place2, most_place);
    }
  look.unsound = any(unsound) ? 1 : 0;
  look.gone2 = largest(most_gone);
  look.speed2 = largest(most_speed);
  look.place2 = largest(most_place);
}
