// Contact of a vector of particles with spheres and the floor, operation by operation as docs/float-form.md
// "Contact". Included by kernel_text.h.

struct Touched {
  Vec3 x, v;
};

/// No approach along n, Coulomb friction on the rest.
WEFT_INLINE Vec3 respond(Vec3 v, Vec3 surface, Vec3 n, Vec friction) {
  const Vec3 relative = v - surface;
  const Vec approach = dot(relative, n);
  const Vec3 tangential = relative - approach * n;
  const Vec speed = root(dot(tangential, tangential));
  const Vec cut = friction * (-approach);
  const Vec keep = select(speed > cut, splat(1.0f) - cut / speed, Vec{});
  return select(approach >= Vec{}, v, surface + keep * tangential);
}

/// Out of line, for it is rare: some lane may be touched.
__attribute__((noinline)) void touch_sphere(const Sphere& sphere, const Vec3& x0, Vec3& x1, Vec3& v) {
  const Vec3 center = splat3(sphere.center);
  const Vec3 p0 = x0 - (center - splat3(sphere.travel)), p1 = x1 - center, path = p1 - p0;
  const Vec reach = splat(sphere.reach), depth = splat(0.99f) * reach;
  const Vec depth2 = depth * depth, reach2 = reach * reach, zero{};
  const Vec a = dot(path, path), b = dot(p0, path), c0 = dot(p0, p0), c1 = dot(p1, p1);
  const Vec nearest = select(dot(p1, path) > zero, c0 - (b * b) / a, c1);
  const Mask entered = (b < zero) & (c0 >= depth2) & (nearest < depth2);
  const Mask hit = entered | (c1 < reach2);
  const Vec k = b * b - a * (c0 - reach2);
  const Vec tau = (-b - root(select(k < zero, zero, k))) / a;
  const Vec3 point = select(entered, p0 + select(tau < zero, zero, tau) * path, p1);
  const Vec l = root(dot(point, point));
  const Vec3 up{zero, splat(1.0f), zero};
  const Vec3 n = select(l > splat(kNoLength), (splat(1.0f) / l) * point, up);
  const Vec3 surface = reach * n;
  const Vec3 along = p1 - dot(p1 - surface, n) * n;
  x1 = select(hit, center + select(entered, along, surface), x1);
  v = select(hit, respond(v, splat3(sphere.velocity), n, splat(sphere.friction)), v);
}

/// Whether touch_sphere would change anything: a particle ends inside, or passes its nearest point in this
/// very drift, which few do.
WEFT_INLINE bool may_touch(const Sphere& sphere, Vec3 x0, Vec3 x1) {
  const Vec3 center = splat3(sphere.center);
  const Vec3 p0 = x0 - (center - splat3(sphere.travel)), p1 = x1 - center, path = p1 - p0;
  const Vec reach = splat(sphere.reach);
  return any((dot(p1, p1) < reach * reach) | ((dot(p0, path) < Vec{}) & (dot(p1, path) > Vec{})));
}

/// Out of line likewise: a vector that nothing touches keeps its registers.
__attribute__((noinline)) void touch_all(const Outside& outside, const Kick& kick, const Vec3& x0,
                                         Touched& now) {
  for (std::uint32_t s = 0; s < outside.sphere_count; ++s)
    if (may_touch(kick.spheres[s], x0, now.x)) touch_sphere(kick.spheres[s], x0, now.x, now.v);
  if (!outside.has_floor) return;
  const Vec height = splat(outside.floor_height);
  const Mask below = now.x.y < height;
  if (!any(below)) return;
  now.x.y = select(below, height, now.x.y);
  const Vec3 up{Vec{}, splat(1.0f), Vec{}}, still{};
  now.v = select(below, respond(now.v, still, up, splat(outside.floor_friction)), now.v);
}

/// A side of the box round all spheres.
struct Side {
  int axis = 0;
  /// Beyond it sign times the coordinate is above the plane: of this one nothing is.
  float sign = 1.0f, plane = __builtin_inff();
};

/// The one that a particle is the farthest beyond; right for any, and good for those near it.
WEFT_INLINE Side side_for(const Clear& clear, const float* x, Index stride) {
  Side best;
  float most = -3.4e38f;
  for (int axis = 0; axis < 3; ++axis) {
    const float at = x[axis * stride], above = at - clear.high[axis], below = clear.low[axis] - at;
    if (above > most) most = above, best = {axis, 1.0f, clear.high[axis]};
    if (below > most) most = below, best = {axis, -1.0f, -clear.low[axis]};
  }
  return best;
}

/// Which lanes bodies may touch.
WEFT_INLINE Mask near_bodies(const Near& near, Vec3 x0, Vec3 x1) {
  const auto leaps = [&](Vec a, Vec b) {
    const Vec way = b - a;
    return ~((way < splat(near.leap)) & (-way < splat(near.leap)));
  };
  const auto within = [&](Vec x, int axis) {
    return (x > splat(near.low[axis])) & (x < splat(near.high[axis]));
  };
  return (within(x1.x, 0) & within(x1.y, 1) & within(x1.z, 2)) | leaps(x0.x, x1.x) | leaps(x0.y, x1.y) |
         leaps(x0.z, x1.z);
}

/// What else than floor and spheres a sweep asks about.
struct Asked {
  bool bodies, links;
  float leap2;  ///< LeapAsked's
};

/// Whether floor, spheres or bodies may change anything of a drift from x0 by `way` to x1. A dozen operations
/// where all of them are on one side: a sweep of one row has but two hundred to spare for one part in twenty.
WEFT_INLINE bool may_be_touched(const Outside& outside, const Asked& asked, const Kick& kick,
                                const Side& side, Vec3 x0, Vec3 way, Vec3 x1) {
  if (outside.has_floor && any(x1.y < splat(outside.floor_height))) return true;
  if (outside.sphere_count == 0 && !asked.bodies && !asked.links) return false;
  const auto along = [&](Vec3 x) {
    return splat(side.sign) * (side.axis == 0 ? x.x : side.axis == 1 ? x.y : x.z);
  };
  const Mask clear =
      (smaller(along(x0), along(x1)) > splat(side.plane)) & (dot(way, way) < splat(kick.clear.leap2));
  if (__builtin_expect(!any(~clear), true)) return false;
  bool touched = asked.bodies && any(near_bodies(kick.near, x0, x1));
  if (asked.links && any(~(dot(way, way) < splat(asked.leap2)))) touched = true;
  for (std::uint32_t s = 0; s < outside.sphere_count && !touched; ++s)
    touched = may_touch(kick.spheres[s], x0, x1);
  return touched;
}

WEFT_INLINE Touched touch(const Outside& outside, const Kick& kick, Vec3 x0, Touched free) {
  bool touched = outside.has_floor && any(free.x.y < splat(outside.floor_height));
  for (std::uint32_t s = 0; s < outside.sphere_count && !touched; ++s)
    touched = may_touch(kick.spheres[s], x0, free.x);
  if (!__builtin_expect(touched, false)) return free;
  const Vec3 from = x0;
  Touched now = free;
  touch_all(outside, kick, from, now);
  return now;
}
