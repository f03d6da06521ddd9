// Drag and lift of the triangles around a vector of particles, and wind that differs from place to place,
// operation by operation as docs/float-form.md "Aerodynamics" and "Wind noise". Included by kernel_text.h.

typedef unsigned Words __attribute__((vector_size(4 * WEFT_LANES)));
struct Words3 {
  Words x, y, z;
};

WEFT_INLINE Vec size_of(Vec v) { return select(v < Vec{}, -v, v); }
WEFT_INLINE Vec3 scaled_down(Vec3 a, Vec by) { return {a.x / by, a.y / by, a.z / by}; }

/// Components in (−1, 1) of one lattice point, whose coordinates are hashed already.
WEFT_INLINE Vec3 lattice_vector(Words x, Words y, Words z, unsigned time_and_seed) {
  Words h = x ^ y ^ z ^ time_and_seed;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  h = h ^ (h >> 16);
  const auto component = [&](int shift) {
    return (__builtin_convertvector((Mask)((h >> shift) & 1023u), Vec) - splat(511.5f)) / splat(512.0f);
  };
  return {component(0), component(10), component(20)};
}

WEFT_INLINE Vec3 blend(Vec3 a, Vec3 b, Vec part) { return a + part * (b - a); }

/// Hashed coordinates of the cell's lower and upper corners, and the smoothed place in it.
struct NoiseCell {
  Words3 low, high;
  Vec3 share;
};

Vec3 noise_in_slice(const NoiseCell& cell, unsigned time_and_seed) {
  const auto along_x = [&](Words y, Words z) {
    return blend(lattice_vector(cell.low.x, y, z, time_and_seed),
                 lattice_vector(cell.high.x, y, z, time_and_seed), cell.share.x);
  };
  const auto along_y = [&](Words z) {
    return blend(along_x(cell.low.y, z), along_x(cell.high.y, z), cell.share.y);
  };
  return blend(along_y(cell.low.z), along_y(cell.high.z), cell.share.z);
}

/// One coordinate: its cell's hashed corners and its share.
WEFT_INLINE void place_in_cell(const Air& air, Vec x, float origin, unsigned prime, Words& low, Words& high,
                               Vec& share) {
  Vec q = x * splat(air.cells_1_m) - splat(origin);
  q = select(size_of(q) < splat(air.noise_farthest), q, Vec{});
  const Vec cut = __builtin_convertvector(__builtin_convertvector(q, Mask), Vec);
  const Vec floor = select(cut > q, cut - splat(1.0f), cut);
  const Vec t = q - floor;
  share = (t * t) * (splat(3.0f) - splat(2.0f) * t);
  const Mask cell = __builtin_convertvector(floor, Mask);
  low = (Words)(cell & static_cast<int>(air.noise_period_mask)) * prime;
  high = (Words)((cell + 1) & static_cast<int>(air.noise_period_mask)) * prime;
}

Vec3 noisy_wind(const Air& air, Vec3 x) {
  NoiseCell cell;
  place_in_cell(air, x.x, air.origin[0], 0x8da6b343u, cell.low.x, cell.high.x, cell.share.x);
  place_in_cell(air, x.y, air.origin[1], 0xd8163841u, cell.low.y, cell.high.y, cell.share.y);
  place_in_cell(air, x.z, air.origin[2], 0xcb1ab31fu, cell.low.z, cell.high.z, cell.share.z);
  const unsigned seed = air.seed * 0x9e3779b1u;
  const Vec3 now = noise_in_slice(cell, (air.slice * 0x165667b1u) ^ seed);
  const Vec3 next = noise_in_slice(cell, ((air.slice + 1) * 0x165667b1u) ^ seed);
  return splat3(air.wind) + splat(air.noise_m_s) * blend(now, next, splat(air.slice_share));
}

struct AirSum {
  Vec3 force;
  Vec rate;
};

/// What triangle (a, b, c) adds, where it exists.
WEFT_INLINE void add_air(const Air& air, const Body& a, const Body& b, const Body& c, Vec3 wind, Mask exists,
                         AirSum& sum) {
  const Vec3 n = triangle(a.x, b.x, c.x);
  const Vec3 u = wind - scaled_down((a.v + b.v) + c.v, splat(3.0f));
  const Vec area2 = root(dot(n, n)), speed = root(dot(u, u));
  const Mask acts = exists & (area2 > splat(kNoNormal)) & (speed > splat(kNoLength));
  const Vec drag = splat(air.drag), lift = splat(air.lift);
  const Vec through = dot(u, n), normal_speed = through / area2;
  const Vec along = drag * size_of(through) - lift * ((through * normal_speed) / speed);
  const Vec across = (lift * speed) * normal_speed;
  sum.force = select(acts, sum.force + (along * u + across * n), sum.force);
  sum.rate = select(acts, sum.rate + ((drag + lift) * speed) * area2, sum.rate);
}

/// Rows [first, last): the velocities after the kick, into `kicked`.
void air_kick(const AirKick& k) {
  const Air& air = *k.air;
  for (Index j = k.first; j < k.last; ++j) {
    const bool has_above = j > 0, has_below = j + 1 < k.ny;
    for (Index i = 0; i < k.nx; i += kLanes) {
      const Index column = kColumns + i;
      const Block& block = k.sheet.blocks[k.sheet.block_of[j * k.sheet.block_count + i / kColumns]];
      const Vec w = load(block.inverse_mass + i % kColumns);
      Mask left{}, right{};
      for (int lane = 0; lane < kLanes; ++lane) {
        left[lane] = i + lane > 0 ? -1 : 0;
        right[lane] = i + lane + 1 < k.nx ? -1 : 0;
      }
      const auto at = [&](Index row, int columns) {
        return load_body(k.rows[row] + column + columns, Strides(k.sheet.stride));
      };
      const Body own = at(j, 0);
      const Vec3 wind = air.has_noise ? noisy_wind(air, own.x) : splat3(air.wind);
      AirSum sum{};
      const Body to_left = at(j, -1), to_right = at(j, 1);
      if (has_below) {
        const Body below = at(j + 1, 0), below_left = at(j + 1, -1);
        add_air(air, own, below, to_right, wind, right, sum);
        add_air(air, own, below_left, below, wind, left, sum);
        add_air(air, to_left, below_left, own, wind, left, sum);
      }
      if (has_above) {
        const Body above = at(j - 1, 0), above_right = at(j - 1, 1);
        add_air(air, above_right, own, to_right, wind, right, sum);
        add_air(air, above, own, above_right, wind, right, sum);
        add_air(air, above, to_left, own, wind, left, sum);
      }
      const Vec gain = splat(k.gain);
      const Vec3 change = scaled_down(gain * (w * sum.force), splat(1.0f) + gain * (sum.rate * w));
      store3(k.kicked + j * 3 * k.sheet.stride + column, k.sheet.stride,
             select(w == Vec{}, own.v, own.v + change));
    }
  }
}
