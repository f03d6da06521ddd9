// Wind that differs from place to place: vectors on a lattice of space and time, by an integer hash, and
// smooth between. docs/float-form.md, "Wind noise". No sine: every device has the same bits.
// Source: value noise on a hashed lattice, Perlin 1985, An image synthesizer; the hash ends as MurmurHash3
// does (Appleby).

// Components in (-1, 1), exact.
real3 lattice_vector(int x, int y, int z, uint slice, uint seed) {
  uint h = (uint(x & kNoisePeriodMask) * 0x8da6b343u) ^ (uint(y & kNoisePeriodMask) * 0xd8163841u) ^
           (uint(z & kNoisePeriodMask) * 0xcb1ab31fu) ^ (slice * 0x165667b1u) ^ (seed * 0x9e3779b1u);
  h ^= h >> 16;
  h *= 0x85ebca6bu;
  h ^= h >> 13;
  h *= 0xc2b2ae35u;
  h ^= h >> 16;
  precise real3 whole = real3(real(h & 1023u), real((h >> 10) & 1023u), real((h >> 20) & 1023u));
  precise real3 centred = whole - real(511.5);
  precise real3 scaled = centred * real(0.001953125);
  return scaled;
}

real3 blend(real3 a, real3 b, real share) {
  precise real3 step_to = b - a;
  precise real3 part = share * step_to;
  precise real3 sum = a + part;
  return sum;
}

real3 slice_noise(ivec3 c, real3 s, uint slice, uint seed) {
  real3 x00 = blend(lattice_vector(c.x, c.y, c.z, slice, seed),
                    lattice_vector(c.x + 1, c.y, c.z, slice, seed), s.x);
  real3 x10 = blend(lattice_vector(c.x, c.y + 1, c.z, slice, seed),
                    lattice_vector(c.x + 1, c.y + 1, c.z, slice, seed), s.x);
  real3 x01 = blend(lattice_vector(c.x, c.y, c.z + 1, slice, seed),
                    lattice_vector(c.x + 1, c.y, c.z + 1, slice, seed), s.x);
  real3 x11 = blend(lattice_vector(c.x, c.y + 1, c.z + 1, slice, seed),
                    lattice_vector(c.x + 1, c.y + 1, c.z + 1, slice, seed), s.x);
  return blend(blend(x00, x10, s.y), blend(x01, x11, s.y), s.z);
}

// A place so far away, or none, has the lattice's origin in its stead.
real bounded(real q) { return abs(q) < kNoiseFarthest ? q : real(0.0); }

// @param origin, per_m  the lattice's place [cells] and 1/edge [1/m]
// @param slice, share   the slice of time and the share of the one after it
real3 wind_noise(real3 x, real3 origin, real per_m, uint slice, real share, uint seed) {
  precise real3 scaled = x * per_m;
  precise real3 moved = scaled - origin;
  real3 q = real3(bounded(moved.x), bounded(moved.y), bounded(moved.z));
  real3 low = floor(q);
  precise real3 t = q - low;
  precise real3 twice = real(2.0) * t;
  precise real3 rest = real(3.0) - twice;
  precise real3 squared = t * t;
  precise real3 s = squared * rest;
  ivec3 cell = ivec3(low);
  return blend(slice_noise(cell, s, slice, seed), slice_noise(cell, s, slice + 1u, seed), share);
}
