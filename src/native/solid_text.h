// Contact of a vector of particles with capsules, boxes and a tilted floor, operation by operation as
// docs/float-form.md "Capsules and boxes". A particle whose path may have gone deep is left to the caller,
// for that is rare. Included by kernel_text.h.

WEFT_INLINE Vec3 in_frame(const float (&axes)[3][3], Vec3 r) {
  return {dot(splat3(axes[0]), r), dot(splat3(axes[1]), r), dot(splat3(axes[2]), r)};
}
WEFT_INLINE Vec3 in_world(const float (&axes)[3][3], Vec3 p) {
  return (p.x * splat3(axes[0]) + p.y * splat3(axes[1])) + p.z * splat3(axes[2]);
}
WEFT_INLINE Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct SolidNear {
  Vec distance;
  Vec3 normal;
};

WEFT_INLINE SolidNear near_solid(const Solid& solid, Vec3 p) {
  const auto beyond = [](Vec at, float half) { return select(at < Vec{}, -at, at) - splat(half); };
  const auto side_of = [](Vec at) { return select(at < Vec{}, splat(-1.0f), splat(1.0f)); };
  const Vec zero{}, reach = splat(solid.reach);
  const Vec3 q{beyond(p.x, solid.half[0]), beyond(p.y, solid.half[1]), beyond(p.z, solid.half[2])};
  const Vec3 over{larger(q.x, zero), larger(q.y, zero), larger(q.z, zero)};
  const Vec3 side{side_of(p.x), side_of(p.y), side_of(p.z)};
  const Vec l = root(dot(over, over));
  const Mask outside = l > splat(kNoLength);
  const Vec share = splat(1.0f) / l;
  const Vec3 out{side.x * (over.x * share), side.y * (over.y * share), side.z * (over.z * share)};
  const Mask first = (q.x >= q.y) & (q.x >= q.z), second = ~first & (q.y >= q.z), third = ~first & ~second;
  const Vec deepest = select(first, q.x, select(second, q.y, q.z));
  const Vec3 inner{select(first, side.x, zero), select(second, side.y, zero), select(third, side.z, zero)};
  return {select(outside, l, deepest) - reach, select(outside, out, inner)};
}

/// Which paths from p0 on by `way` may have gone deep.
WEFT_INLINE Mask may_enter_deep(const Solid& solid, Vec3 p0, Vec3 way, Mask movable) {
  const Vec squared = dot(way, way), deep = splat(solid.deep);
  const Mask far = movable & (squared > deep * deep);
  if (!any(far)) return far;
  const Vec outside = near_solid(solid, p0).distance;
  return far & ~((outside < -deep) | ((outside > Vec{}) & (outside * outside > squared)));
}

WEFT_INLINE void touch_solid(const Solid& solid, Vec3 x0, Mask movable, Touched& now, Mask& left) {
  const Vec3 center = splat3(solid.center);
  const Vec3 p0 = in_frame(solid.start_axes, x0 - splat3(solid.start));
  const Vec3 p1 = in_frame(solid.axes, now.x - center);
  left = left | may_enter_deep(solid, p0, p1 - p0, movable);
  const SolidNear near = near_solid(solid, p1);
  const Mask hit = movable & (near.distance < Vec{});
  if (!any(hit)) return;
  const Vec3 arm = in_world(solid.axes, p1 - near.distance * near.normal);
  const Vec3 surface = splat3(solid.velocity) + cross(splat3(solid.spin), arm);
  now.x = select(hit, center + arm, now.x);
  now.v =
      select(hit, respond(now.v, surface, in_world(solid.axes, near.normal), splat(solid.friction)), now.v);
}

WEFT_INLINE void touch_level(float floor_height, float floor_friction, Touched& now) {
  const Vec height = splat(floor_height);
  const Mask below = now.x.y < height;
  now.x.y = select(below, height, now.x.y);
  now.v =
      select(below, respond(now.v, Vec3{}, Vec3{Vec{}, splat(1.0f), Vec{}}, splat(floor_friction)), now.v);
}

WEFT_INLINE void touch_ground(const SolidTouch& t, Touched& now) {
  const Vec3 still{};
  const Vec friction = splat(t.floor_friction);
  if (t.has_level) touch_level(t.floor_height, t.floor_friction, now);
  if (t.has_tilt) {
    const Vec3 n = splat3(t.tilt_normal);
    const Vec above = dot(n, now.x) - splat(t.tilt_level);
    const Mask below = above < Vec{};
    now.x = select(below, now.x - above * n, now.x);
    now.v = select(below, respond(now.v, still, n, friction), now.v);
  }
}

/// Returns how many particles are left over; `left_over` names them and their rows are as they were.
Index touch_solids(const SolidTouch& t) {
  const Index stride = t.sheet.stride;
  Index count = 0;
  for (Index j = t.first; j < t.last; ++j) {
    for (Index i = 0; i < t.nx; i += kLanes) {
      float* const at = t.rows[j] + kColumns + i;
      const Block& block = t.sheet.blocks[t.sheet.block_of[j * t.sheet.block_count + i / kColumns]];
      const Mask movable = load(block.inverse_mass + i % kColumns) != Vec{};
      const Vec3 x0 = load3(t.before + j * 3 * stride + kColumns + i, stride);
      const Vec3 x1 = load3(at, stride);
      const bool on_level = t.has_level && any(x1.y < splat(t.floor_height));
      if (t.near && !t.has_tilt && !on_level && !any(near_bodies(*t.near, x0, x1))) continue;
      const Touched free{x1, load3(at + 3 * stride, stride)};
      Touched now = free;
      Mask left{};
      for (std::uint32_t s = 0; s < t.solid_count; ++s) touch_solid(t.solids[s], x0, movable, now, left);
      touch_ground(t, now);
      if (any(left))
        for (int lane = 0; lane < kLanes; ++lane)
          if (left[lane]) t.left_over[count++] = static_cast<std::uint32_t>(j * t.nx + i + lane);
      const Mask moves = movable & ~left;
      store3(at, stride, select(moves, now.x, free.x));
      store3(at + 3 * stride, stride, select(moves, now.v, free.v));
    }
  }
  return count;
}

/// Contact of a drift within the sweep: vectors of capsules and boxes; meshes, and who may have gone deep,
/// are listed for afterwards.
WEFT_INLINE void touch_bodies(const Outside& outside, const Bodies& bodies, const Kick& kick, Vec3 x0,
                              Mask movable, float* own, Touched& next, Index& listed) {
  const Mask near = near_bodies(kick.near, x0, next.x) & movable;
  if (!any(near)) return;
  Mask left{};
  if (bodies.solid_count > 0) {
    Touched now = next;
    for (std::uint32_t s = 0; s < bodies.solid_count; ++s) touch_solid(kick.solids[s], x0, near, now, left);
    if (outside.has_floor) touch_level(outside.floor_height, outside.floor_friction, now);
    const Mask moves = near & ~left;
    next.x = select(moves, now.x, next.x);
    next.v = select(moves, now.v, next.v);
  }
  for (unsigned lanes = bits_of(bodies.has_meshes ? near : left); lanes != 0; lanes &= lanes - 1) {
    const int lane = __builtin_ctz(lanes);
    bodies.list[listed++] = {own + lane, {x0.x[lane], x0.y[lane], x0.z[lane]}, left[lane] != 0 ? 1u : 0u};
  }
}
