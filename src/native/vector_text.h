// Vectors of WEFT_LANES floats for one kernel file, which includes this inside its own anonymous namespace
// after its intrinsics. No header of the standard library may be included here: its inline functions would be
// compiled for instructions that the rest of the program must not use.
#define WEFT_INLINE inline __attribute__((always_inline))

constexpr int kLanes = WEFT_LANES;
typedef float Vec __attribute__((vector_size(4 * WEFT_LANES)));
typedef int Mask __attribute__((vector_size(4 * WEFT_LANES)));

WEFT_INLINE Vec load(const float* from) {
  Vec v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
WEFT_INLINE void store(float* to, Vec v) { __builtin_memcpy(to, &v, sizeof v); }
WEFT_INLINE Vec splat(float value) { return value - Vec{}; }
WEFT_INLINE Vec select(Mask mask, Vec yes, Vec no) { return mask ? yes : no; }

#if WEFT_LANES == 16
// The forms with a full mask: g++ 12 takes the plain ones' undefined operand for one that was forgotten.
constexpr __mmask16 kAll = 0xffff;
WEFT_INLINE Vec root(Vec v) { return (Vec)_mm512_maskz_sqrt_ps(kAll, (__m512)v); }
WEFT_INLINE Vec larger(Vec a, Vec b) { return (Vec)_mm512_maskz_max_ps(kAll, (__m512)a, (__m512)b); }
WEFT_INLINE Vec smaller(Vec a, Vec b) { return (Vec)_mm512_maskz_min_ps(kAll, (__m512)a, (__m512)b); }
WEFT_INLINE unsigned bits_of(Mask m) { return _mm512_movepi32_mask((__m512i)m); }
#elif WEFT_LANES == 8
WEFT_INLINE Vec root(Vec v) { return (Vec)_mm256_sqrt_ps((__m256)v); }
WEFT_INLINE Vec larger(Vec a, Vec b) { return (Vec)_mm256_max_ps((__m256)a, (__m256)b); }
WEFT_INLINE Vec smaller(Vec a, Vec b) { return (Vec)_mm256_min_ps((__m256)a, (__m256)b); }
WEFT_INLINE unsigned bits_of(Mask m) { return static_cast<unsigned>(_mm256_movemask_ps((__m256)m)); }
#elif defined(WEFT_SSE)
WEFT_INLINE Vec root(Vec v) { return (Vec)_mm_sqrt_ps((__m128)v); }
WEFT_INLINE Vec larger(Vec a, Vec b) { return (Vec)_mm_max_ps((__m128)a, (__m128)b); }
WEFT_INLINE Vec smaller(Vec a, Vec b) { return (Vec)_mm_min_ps((__m128)a, (__m128)b); }
WEFT_INLINE unsigned bits_of(Mask m) { return static_cast<unsigned>(_mm_movemask_ps((__m128)m)); }
#else
WEFT_INLINE Vec root(Vec v) {
  for (int lane = 0; lane < kLanes; ++lane) v[lane] = __builtin_sqrtf(v[lane]);
  return v;
}
/// a where it is the larger, else b: also where a is no number. So smaller.
WEFT_INLINE Vec larger(Vec a, Vec b) { return select(a > b, a, b); }
WEFT_INLINE Vec smaller(Vec a, Vec b) { return select(a < b, a, b); }
WEFT_INLINE unsigned bits_of(Mask m) {
  unsigned bits = 0;
  for (int lane = 0; lane < kLanes; ++lane) bits |= (m[lane] < 0 ? 1u : 0u) << lane;
  return bits;
}
#endif
/// Whether a lane is set; bits_of: the lanes that are, the first one lowest.
WEFT_INLINE bool any(Mask m) { return bits_of(m) != 0; }

/// The vector that begins one lane before `now`, `before` being the one to its left; then two lanes before.
#if WEFT_LANES == 16
WEFT_INLINE Vec one_left(Vec before, Vec now) {
  return __builtin_shufflevector(before, now, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30);
}
WEFT_INLINE Vec two_left(Vec before, Vec now) {
  return __builtin_shufflevector(before, now, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29);
}
#elif WEFT_LANES == 8
WEFT_INLINE Vec one_left(Vec before, Vec now) {
  return __builtin_shufflevector(before, now, 7, 8, 9, 10, 11, 12, 13, 14);
}
WEFT_INLINE Vec two_left(Vec before, Vec now) {
  return __builtin_shufflevector(before, now, 6, 7, 8, 9, 10, 11, 12, 13);
}
#else
WEFT_INLINE Vec one_left(Vec before, Vec now) { return __builtin_shufflevector(before, now, 3, 4, 5, 6); }
WEFT_INLINE Vec two_left(Vec before, Vec now) { return __builtin_shufflevector(before, now, 2, 3, 4, 5); }
#endif

WEFT_INLINE void fill(float* from, const float* end, float value) {
  for (; from != end; ++from) *from = value;
}

/// The largest whole number that is not above; of what is far from overflow.
WEFT_INLINE Mask floored(Vec at) {
  const Mask cut = __builtin_convertvector(at, Mask);
  return cut + (__builtin_convertvector(cut, Vec) > at);
}

/// Every other lane of two vectors in a row, from the first and from the second on.
#if WEFT_LANES == 16
WEFT_INLINE Vec evens(Vec a, Vec b) {
  return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
}
WEFT_INLINE Vec odds(Vec a, Vec b) {
  return __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
}
#elif WEFT_LANES == 8
WEFT_INLINE Vec evens(Vec a, Vec b) { return __builtin_shufflevector(a, b, 0, 2, 4, 6, 8, 10, 12, 14); }
WEFT_INLINE Vec odds(Vec a, Vec b) { return __builtin_shufflevector(a, b, 1, 3, 5, 7, 9, 11, 13, 15); }
#else
WEFT_INLINE Vec evens(Vec a, Vec b) { return __builtin_shufflevector(a, b, 0, 2, 4, 6); }
WEFT_INLINE Vec odds(Vec a, Vec b) { return __builtin_shufflevector(a, b, 1, 3, 5, 7); }
#endif

/// The lanes' own numbers, from `first` on.
WEFT_INLINE Mask lanes_from(int first) {
  Mask lanes{};
  for (int lane = 0; lane < kLanes; ++lane) lanes[lane] = lane;
  return lanes + first;
}

/// Of numbers from 0 on; what is no number does not count.
WEFT_INLINE float largest(Vec v) {
  float most = 0.0f;
  for (int lane = 0; lane < kLanes; ++lane)
    if (v[lane] > most) most = v[lane];
  return most;
}

struct Vec3 {
  Vec x, y, z;
};
WEFT_INLINE Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
WEFT_INLINE Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
WEFT_INLINE Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
WEFT_INLINE Vec3 operator*(Vec s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
WEFT_INLINE Vec dot(Vec3 a, Vec3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
WEFT_INLINE Vec3 one_left(Vec3 before, Vec3 now) {
  return {one_left(before.x, now.x), one_left(before.y, now.y), one_left(before.z, now.z)};
}
WEFT_INLINE Vec3 two_left(Vec3 before, Vec3 now) {
  return {two_left(before.x, now.x), two_left(before.y, now.y), two_left(before.z, now.z)};
}
WEFT_INLINE Vec3 select(Mask m, Vec3 yes, Vec3 no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}
WEFT_INLINE Vec3 splat3(const float (&v)[3]) { return {splat(v[0]), splat(v[1]), splat(v[2])}; }
WEFT_INLINE Vec3 load3(const float* from, decltype(sizeof 0) stride) {
  return {load(from), load(from + stride), load(from + 2 * stride)};
}
WEFT_INLINE void store3(float* to, decltype(sizeof 0) stride, Vec3 v) {
  store(to, v.x);
  store(to + stride, v.y);
  store(to + 2 * stride, v.z);
}
