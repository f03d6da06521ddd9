// How far listed triangles and edges are from each other, a vector of entries at a time, as
// docs/float-form.md "Surfaces". Included by kernel_text.h.

/// The first three of each lane's vec4.
WEFT_INLINE Vec3 gather_vec4(const float* all, const std::uint32_t* particles) {
  alignas(64) float at[4 * kLanes];
  for (int lane = 0; lane < kLanes; ++lane)
    __builtin_memcpy(at + 4 * lane, all + 4 * static_cast<Index>(particles[lane]), 4 * sizeof(float));
  return load_vec4(at, kLanes);
}

/// What two primitives are to each other: of the four particles the weights in the distance, and the
/// distance.
struct Apart {
  Vec weight[4];
  Vec3 d;
};

/// A particle and a triangle: the regions' results are chosen backwards, so that the first that holds counts.
/// Source: Ericson 2005, section 5.1.5.
WEFT_INLINE Apart from_triangle(const Vec3 (&x)[4]) {
  const Vec zero{}, one = splat(1.0f);
  const Vec3 ab = x[2] - x[1], ac = x[3] - x[1], ap = x[0] - x[1], bp = x[0] - x[2], cp = x[0] - x[3];
  const Vec d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
            d6 = dot(ac, cp);
  const Vec va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  const Vec along = d1 - d3, sum = (va + vb) + vc;
  const Mask first = (d1 <= 0.0f) & (d2 <= 0.0f), second = (d3 >= 0.0f) & (d4 <= d3),
             third = (d6 >= 0.0f) & (d5 <= d6);
  const Mask on_ab = (vc <= 0.0f) & (d1 >= 0.0f) & (d3 <= 0.0f) & (along > 0.0f),
             on_ac = (vb <= 0.0f) & (d2 >= 0.0f) & (d6 <= 0.0f),
             on_bc = (va <= 0.0f) & (d4 - d3 >= 0.0f) & (d5 - d6 >= 0.0f);
  // One division each of v and w, whichever region they are of.
  Vec w = select(on_bc, d4 - d3, vc), below_w = select(on_bc, (d4 - d3) + (d5 - d6), sum);
  w = select(on_ac, d2, w) / select(on_ac, d2 - d6, below_w);
  Vec v = select(on_ab, d1, vb) / select(on_ab, along, sum);
  Vec u = (one - v) - w;
  const auto choose = [&](Mask mask, Vec of_first, Vec of_second, Vec of_third) {
    u = select(mask, of_first, u);
    v = select(mask, of_second, v);
    w = select(mask, of_third, w);
  };
  const Vec v_on_ab = v, w_on = w;
  choose(on_bc, zero, one - w_on, w_on);
  choose(on_ac, one - w_on, zero, w_on);
  choose(third, zero, zero, one);
  choose(on_ab, one - v_on_ab, v_on_ab, zero);
  choose(second, zero, one, zero);
  choose(first, one, zero, zero);
  return {{one, -u, -v, -w}, ap - (v * ab + w * ac)};
}

/// At least 0 and at most 1; no number stays none.
WEFT_INLINE Vec share_of(Vec x) {
  const Vec zero{}, one = splat(1.0f);
  x = select(x < zero, zero, x);
  return select(one < x, one, x);
}

/// Two edges. Source: Ericson 2005, section 5.1.9.
WEFT_INLINE Apart from_edge(const Vec3 (&x)[4], Vec tiny) {
  const Vec zero{}, one = splat(1.0f);
  const Vec3 own = x[1] - x[0], its = x[3] - x[2], between = x[0] - x[2];
  Vec aa = dot(own, own), ee = dot(its, its);
  aa = select(aa < tiny, tiny, aa);
  ee = select(ee < tiny, tiny, ee);
  const Vec mixed = dot(own, its), ar = dot(own, between), er = dot(its, between);
  const Vec det = aa * ee - mixed * mixed;
  Vec s = select(det > zero, share_of((mixed * er - ar * ee) / det), zero);
  Vec t = (mixed * s + er) / ee;
  const Mask before = t<zero, beyond = t> one;
  s = select(before | beyond, share_of(select(before, -ar, mixed - ar) / aa), s);
  t = select(before, zero, select(beyond, one, t));
  return {{one - s, s, -(one - t), -t}, (between + s * own) - t * its};
}

/// Blocks of entries: every distance, and whole what is nearer than the limit; returns how many that are.
template <bool kEdges>
std::size_t look_at_surfaces(const SurfaceLook& look) {
  std::size_t touching = 0;
  for (Index at = 0; at < look.count; at += kLanes) {
    const std::uint32_t* const corner = look.corners + at / kColumns * (4 * kColumns) + at % kColumns;
    const Vec3 x[4] = {gather_vec4(look.near, corner), gather_vec4(look.near, corner + kColumns),
                       gather_vec4(look.near, corner + 2 * kColumns),
                       gather_vec4(look.near, corner + 3 * kColumns)};
    const Apart apart = kEdges ? from_edge(x, splat(look.edge_tiny)) : from_triangle(x);
    const Vec squared = dot(apart.d, apart.d);
    store(look.distances + at, root(squared));
    const Mask own = lanes_from(static_cast<int>(at)) < static_cast<int>(look.count);
    const unsigned near = bits_of((squared < splat(look.limit_squared)) & own);
    if (near == 0) continue;
    alignas(64) float result[8][kLanes];
    for (int m = 0; m < 4; ++m) store(result[m], apart.weight[m]);
    store3(result[4], kLanes, apart.d);
    store(result[7], squared);
    for (unsigned lanes = near; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      SurfaceTouch& touch = look.touching[touching++];
      for (int m = 0; m < 4; ++m) {
        touch.particle[m] = corner[m * static_cast<int>(kColumns) + lane];
        touch.weight[m] = result[m][lane];
      }
      for (int axis = 0; axis < 3; ++axis) touch.d[axis] = result[4 + axis][lane];
      touch.squared = result[7][lane];
      touch.edges = kEdges;
    }
  }
  return touching;
}
