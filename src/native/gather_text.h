// Of points in blocks, those near one point. Included by kernel_text.h.

std::size_t find_near(const NearPoints& look) {
  const Vec3 at = splat3(look.at);
  const Vec limit = splat(look.squared);
  std::uint32_t* to = look.found;
  for (Index first = 0; first < look.count; first += kColumns) {
    const float* const from = look.points + 3 * first;
    for (Index base = 0; base < kColumns; base += kLanes) {
      const Vec3 d = load3(from + base, kColumns) - at;
      for (unsigned near = bits_of(dot(d, d) < limit); near != 0; near &= near - 1)
        *to++ = static_cast<std::uint32_t>(first + base) + static_cast<std::uint32_t>(__builtin_ctz(near));
    }
  }
  return static_cast<std::size_t>(to - look.found);
}
