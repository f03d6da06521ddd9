// The sweep of docs/float-form.md with each spring evaluated once and the state updated in place: after a row
// has computed its six forward springs, nobody needs its old positions. Included by one kernel file a width.
#include "native/vector_text.h"

using Index = decltype(sizeof 0);
constexpr float kTinyLengthSquared = 1e-24f;  // as shared/params.h, which includes library headers
constexpr float kNoLength = 1e-12f;
constexpr float kNoNormal = 1e-30f;

struct Body {
  Vec3 x, v;
};
WEFT_INLINE Body load_body(const float* at, Index stride) {
  return {load3(at, stride), load3(at + 3 * stride, stride)};
}

/// (q − p) × (r − p), each component product minus product.
WEFT_INLINE Vec3 triangle(Vec3 p, Vec3 q, Vec3 r) {
  const Vec3 a = q - p, b = r - p;
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#include "native/air_text.h"
#include "native/contact_text.h"
#include "native/solid_text.h"
#include "native/surface_text.h"
#include "native/tear_text.h"
#include "native/xpbd_text.h"

/// The force on a; docs/float-form.md "One pair".
template <bool kDamped>
WEFT_INLINE Vec3 pair_force(const Body& a, const Body& b, const PairColumns& row, Index lane) {
  const Vec3 d = b.x - a.x;
  const Vec q = larger(dot(d, d), splat(kTinyLengthSquared));
  const Vec r = splat(1.0f) / root(q);
  const Vec k = load(row.k + lane), l = load(row.l + lane);
  if constexpr (kDamped) {
    const Vec3 dv = b.v - a.v;
    const Vec c = load(row.c + lane);
    return (((c * dot(d, dv)) * r - l) * r + k) * d;
  } else {
    return (k - l * r) * d;
  }
}

/// What the vectors to the left hand on: fT − f10, f11 and f20.
struct FromLeft {
  Vec3 cross{}, down{}, two{};
};

/// Where a vector of particles stands: its own row and the two below, at its first column.
struct Place {
  float* own;
  const float *below, *below_two;
  float *carried, *carried_two;
  Index stride;
};

/// The springs to the row below and what they leave for its particles: P, and the force of (0,2).
template <std::uint32_t kEffects>
WEFT_INLINE void springs_down(const Place& at, const Body& own, const Block& block, Index lane,
                              FromLeft& left) {
  constexpr bool kDamped = kEffects & kDamping;
  const Body below = load_body(at.below, at.stride);
  const Vec3 f01 = pair_force<kDamped>(own, below, block.pairs[kPair01], lane);
  Vec3 out = f01;
  if constexpr (kEffects & kTwoApart) out = load3(at.carried_two, at.stride) + f01;
  if constexpr (kEffects & kShear) {
    out = out + pair_force<kDamped>(load_body(at.own + 1, at.stride), below, block.pairs[kPairT], lane);
    const Vec3 f11 = pair_force<kDamped>(own, load_body(at.below + 1, at.stride), block.pairs[kPair11], lane);
    out = out + one_left(left.down, f11);
    left.down = f11;
  }
  store3(at.carried, at.stride, out);
}

template <std::uint32_t kEffects>
WEFT_INLINE void spring_two_down(const Place& at, const Body& own, const Block& block, Index lane) {
  const Body below_two = load_body(at.below_two, at.stride);
  store3(at.carried_two, at.stride,
         pair_force<(kEffects & kDamping) != 0>(own, below_two, block.pairs[kPair02], lane));
}

/// The whole force on the particles, every forward spring once.
template <std::uint32_t kEffects>
WEFT_INLINE Vec3 force_on(const Place& at, const Body& own, const Block& block, Index lane, FromLeft& left) {
  constexpr bool kDamped = kEffects & kDamping;
  const Body below = load_body(at.below, at.stride), right = load_body(at.own + 1, at.stride);
  const Vec3 f01 = pair_force<kDamped>(own, below, block.pairs[kPair01], lane);
  Vec3 force = f01 - load3(at.carried, at.stride);
  Vec3 out = f01;
  if constexpr (kEffects & kTwoApart) out = load3(at.carried_two, at.stride) + f01;
  Vec3 cross{};
  if constexpr (kEffects & kShear) {
    cross = pair_force<kDamped>(right, below, block.pairs[kPairT], lane);
    out = out + cross;
  }
  const Vec3 f10 = pair_force<kDamped>(own, right, block.pairs[kPair10], lane);
  force = force + f10;
  cross = cross - f10;
  force = force + one_left(left.cross, cross);
  left.cross = cross;
  if constexpr (kEffects & kShear) {
    const Vec3 f11 = pair_force<kDamped>(own, load_body(at.below + 1, at.stride), block.pairs[kPair11], lane);
    force = force + f11;
    out = out + one_left(left.down, f11);
    left.down = f11;
  }
  store3(at.carried, at.stride, out);
  if constexpr (kEffects & kTwoApart) {
    const Vec3 f20 = pair_force<kDamped>(own, load_body(at.own + 2, at.stride), block.pairs[kPair20], lane);
    force = (force + f20) - two_left(left.two, f20);
    left.two = f20;
    const Body below_two = load_body(at.below_two, at.stride);
    const Vec3 f02 = pair_force<kDamped>(own, below_two, block.pairs[kPair02], lane);
    force = force + f02;
    store3(at.carried_two, at.stride, f02);
  }
  return force;
}

/// docs/float-form.md "Kick and drift" and contact, in place. Gravity and wind are one predicted jump and one
/// addition each, so that they need no variant of their own; nor does velocity Verlet, whose springs see the
/// velocity that it predicts.
template <std::uint32_t kEffects>
WEFT_INLINE void move(const Sweep& sweep, const Place& at, float* half_velocity, const Body& own, Vec3 force,
                      const Block& block, Index lane) {
  const Kick& kick = *sweep.kick;
  const Vec w = load(block.inverse_mass + lane);
  Vec3 acceleration = w * force;
  if (sweep.outside.has_gravity) acceleration = acceleration + splat3(sweep.outside.gravity);
  if (sweep.outside.has_wind) acceleration = acceleration + splat3(kick.alpha_wind);
  Vec3 change = splat(kick.gain) * acceleration;
  const bool predicts = half_velocity != nullptr;
  const Vec3 before = predicts && !kick.begins_frame ? load3(half_velocity, at.stride) : own.v;
  if constexpr (kEffects & kAir) change = change - splat(kick.loss) * before;
  Touched next;
  next.v = before + change;
  next.x = own.x + splat(kick.drift) * next.v;
  if constexpr (kEffects & kContact)
    if (kick.drift > 0.0f) next = touch(sweep.outside, kick, own.x, next);
  if (predicts) {
    store3(half_velocity, at.stride, next.v);
    Vec3 further = splat(kick.predict_gain) * acceleration;
    if constexpr (kEffects & kAir) further = further - splat(kick.predict_loss) * next.v;
    next.v = next.v + further;
  }
  if (block.has_fixed) {
    const Mask fixed = w == Vec{};
    next.x = select(fixed, own.x, next.x);
    next.v = select(fixed, own.v, next.v);
  }
  store3(at.own, at.stride, next.x);
  store3(at.own + 3 * at.stride, at.stride, next.v);
}

enum class Part { two_above, above, own };

/// One row: the two above a band only leave what reaches into it.
template <std::uint32_t kEffects, Part kPart>
WEFT_INLINE void sweep_row(const Sweep& sweep, Index j) {
  const Sheet& sheet = sweep.sheet;
  FromLeft left;
  for (Index b = 0; b < sheet.block_count; ++b) {
    const Block& block = sheet.blocks[sheet.block_of[j * sheet.block_count + b]];
    for (Index lane = 0; lane < kColumns; lane += kLanes) {
      const Index column = kColumns + b * kColumns + lane;
      const Place at{sweep.rows[j] + column, sweep.rows[j + 1] + column, sweep.rows[j + 2] + column,
                     sweep.carried + column, sweep.carried_two + column, sheet.stride};
      const Body own = load_body(at.own, sheet.stride);
      if constexpr (kPart == Part::own) {
        float* const half =
            sweep.half_velocity == nullptr ? nullptr : sweep.half_velocity + j * 3 * sheet.stride + column;
        move<kEffects>(sweep, at, half, own, force_on<kEffects>(at, own, block, lane, left), block, lane);
      } else {
        if constexpr (kPart == Part::above) springs_down<kEffects>(at, own, block, lane, left);
        if constexpr (kEffects & kTwoApart) spring_two_down<kEffects>(at, own, block, lane);
      }
    }
  }
}

template <std::uint32_t kEffects>
void sweep_rows(const Sweep& sweep) {
  constexpr std::uint32_t kSprings = kEffects & (kDamping | kShear | kTwoApart);
  const Index floats = 3 * sweep.sheet.stride;
  __builtin_memset(sweep.carried, 0, floats * sizeof(float));
  __builtin_memset(sweep.carried_two, 0, floats * sizeof(float));
  if (sweep.first > 0) {
    if constexpr (kSprings & kTwoApart) sweep_row<kSprings, Part::two_above>(sweep, sweep.first - 2);
    sweep_row<kSprings, Part::above>(sweep, sweep.first - 1);
  }
  for (Index j = sweep.first; j < sweep.last; ++j) sweep_row<kEffects, Part::own>(sweep, j);
}

/// Sixteen independent chains of 1/√x hide the latency; their sum keeps them alive.
float divide(std::uint64_t repeats) {
  constexpr int kChains = 8;
  Vec chain[kChains];
  for (int c = 0; c < kChains; ++c) chain[c] = splat(1.5f + static_cast<float>(c));
  for (std::uint64_t n = 0; n < repeats; n += kChains)
    for (int c = 0; c < kChains; ++c) chain[c] = splat(1.0f) / root(chain[c]);
  float sum = 0.0f;
  for (int c = 0; c < kChains; ++c) sum += chain[c][0];
  return sum;
}

template <std::uint32_t... kVariant>
struct Variants {};
template <std::uint32_t kCount, std::uint32_t... kVariant>
struct UpTo : UpTo<kCount - 1, kCount - 1, kVariant...> {};
template <std::uint32_t... kVariant>
struct UpTo<0, kVariant...> {
  using List = Variants<kVariant...>;
};

template <std::uint32_t... kVariant>
constexpr Kernels kernels_of(const char* name, Variants<kVariant...>) {
  return {name,
          kLanes,
          {sweep_rows<kVariant>...},
          surface,
          air_kick,
          touch_solids,
          tear,
          xpbd_predict,
          xpbd_finish,
          {{pull_along_i<false>, pull_along_j<false, 1>, pull_across<false, false>, pull_across<false, true>,
            pull_two_along_i<false>, pull_along_j<false, 2>, bend_along_i, bend_along_j},
           {pull_along_i<true>, pull_along_j<true, 1>, pull_across<true, false>, pull_across<true, true>,
            pull_two_along_i<true>, pull_along_j<true, 2>, bend_along_i, bend_along_j}},
          divide};
}
