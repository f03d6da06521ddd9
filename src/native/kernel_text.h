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

/// How far a row's arrays are apart, in bytes: with these three every address is a base, a register and a
/// factor. Sixty addresses a vector that are summed up instead cost a tenth of the sweep with AVX2.
struct Strides {
  explicit Strides(Index floats) : one(4 * floats), three(12 * floats), five(20 * floats) {}
  Index one, three, five;
};
WEFT_INLINE const float* beyond(const float* at, Index bytes) {
  return reinterpret_cast<const float*>(reinterpret_cast<const char*>(at) + bytes);
}
WEFT_INLINE float* beyond(float* at, Index bytes) {
  return reinterpret_cast<float*>(reinterpret_cast<char*>(at) + bytes);
}
/// The first three arrays of a row, and the others.
WEFT_INLINE Vec3 load_first(const float* at, Strides s) {
  return {load(at), load(beyond(at, s.one)), load(beyond(at, 2 * s.one))};
}
WEFT_INLINE Vec3 load_last(const float* at, Strides s) {
  return {load(beyond(at, s.three)), load(beyond(at, 4 * s.one)), load(beyond(at, s.five))};
}
WEFT_INLINE void store_first(float* at, Strides s, Vec3 v) {
  store(at, v.x);
  store(beyond(at, s.one), v.y);
  store(beyond(at, 2 * s.one), v.z);
}
WEFT_INLINE void store_last(float* at, Strides s, Vec3 v) {
  store(beyond(at, s.three), v.x);
  store(beyond(at, 4 * s.one), v.y);
  store(beyond(at, s.five), v.z);
}
WEFT_INLINE Body load_body(const float* at, Strides s) { return {load_first(at, s), load_last(at, s)}; }

/// (q − p) × (r − p), each component product minus product.
WEFT_INLINE Vec3 triangle(Vec3 p, Vec3 q, Vec3 r) {
  const Vec3 a = q - p, b = r - p;
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

#include "native/air_text.h"
#include "native/contact_text.h"
#include "native/fold_text.h"
#include "native/gather_text.h"
#include "native/leash_text.h"
#include "native/link_text.h"
#include "native/near_text.h"
#include "native/patch_text.h"
#include "native/solid_text.h"
#include "native/spread_text.h"
#include "native/surface_text.h"
#include "native/tear_text.h"
#include "native/touch_text.h"
#include "native/xpbd_text.h"

/// The force on b, minus that on a; docs/float-form.md "One pair". The sweep adds up these, so that b's
/// arrays are subtracted where they lie: no rounding depends on the sign.
template <bool kDamped>
WEFT_INLINE Vec3 pair_force(const Body& a, const Body& b, const PairColumns& row, Index lane) {
  const Vec3 d = a.x - b.x;
  const Vec q = larger(dot(d, d), splat(kTinyLengthSquared));
  const Vec r = splat(1.0f) / root(q);
  const Vec k = load(row.k + lane), l = load(row.l + lane);
  if constexpr (kDamped) {
    const Vec3 dv = a.v - b.v;
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
  float* carried;
  Strides strides;
};

/// The springs to the row below and what they leave for its particles: P, and the force of (0,2).
template <std::uint32_t kEffects>
WEFT_INLINE void springs_down(const Place& at, const Body& own, const Block& block, Index lane,
                              FromLeft& left) {
  constexpr bool kDamped = kEffects & kDamping;
  const Strides s = at.strides;
  const Body below = load_body(at.below, s);
  const Vec3 f01 = pair_force<kDamped>(own, below, block.pairs[kPair01], lane);
  Vec3 out = f01;
  if constexpr (kEffects & kTwoApart) out = load_last(at.carried, s) + f01;
  if constexpr (kEffects & kShear) {
    out = out + pair_force<kDamped>(load_body(at.own + 1, s), below, block.pairs[kPairT], lane);
    const Vec3 f11 = pair_force<kDamped>(own, load_body(at.below + 1, s), block.pairs[kPair11], lane);
    out = out + one_left(left.down, f11);
    left.down = f11;
  }
  store_first(at.carried, s, out);
}

template <std::uint32_t kEffects>
WEFT_INLINE void spring_two_down(const Place& at, const Body& own, const Block& block, Index lane) {
  const Body below_two = load_body(at.below_two, at.strides);
  store_last(at.carried, at.strides,
             pair_force<(kEffects & kDamping) != 0>(own, below_two, block.pairs[kPair02], lane));
}

/// Minus the whole force on the particles, every forward spring once. `between` runs amid the springs.
template <std::uint32_t kEffects, class Between>
WEFT_INLINE Vec3 reaction_of(const Place& at, const Body& own, const Block& block, Index lane, FromLeft& left,
                             const Between& between) {
  constexpr bool kDamped = kEffects & kDamping;
  const Strides s = at.strides;
  const Body below = load_body(at.below, s), right = load_body(at.own + 1, s);
  const Vec3 f01 = pair_force<kDamped>(own, below, block.pairs[kPair01], lane);
  Vec3 sum = f01 - load_first(at.carried, s);
  Vec3 out = f01;
  if constexpr (kEffects & kTwoApart) out = load_last(at.carried, s) + f01;
  Vec3 cross{};
  if constexpr (kEffects & kShear) {
    cross = pair_force<kDamped>(right, below, block.pairs[kPairT], lane);
    out = out + cross;
  }
  between();
  const Vec3 f10 = pair_force<kDamped>(own, right, block.pairs[kPair10], lane);
  sum = sum + f10;
  cross = cross - f10;
  sum = sum + one_left(left.cross, cross);
  left.cross = cross;
  if constexpr (kEffects & kShear) {
    const Vec3 f11 = pair_force<kDamped>(own, load_body(at.below + 1, s), block.pairs[kPair11], lane);
    sum = sum + f11;
    out = out + one_left(left.down, f11);
    left.down = f11;
  }
  store_first(at.carried, s, out);
  if constexpr (kEffects & kTwoApart) {
    const Vec3 f20 = pair_force<kDamped>(own, load_body(at.own + 2, s), block.pairs[kPair20], lane);
    sum = (sum + f20) - two_left(left.two, f20);
    left.two = f20;
    const Vec3 f02 = pair_force<kDamped>(own, load_body(at.below_two, s), block.pairs[kPair02], lane);
    sum = sum + f02;
    store_last(at.carried, s, f02);
  }
  return sum;
}

/// A substep's kick, drift and what acts on all alike, copied so that no store can change it.
struct Acting {
  Outside outside;
  Kick kick;
  Bodies bodies;
  std::uint32_t* leapt;
  KicksAsked kicks;
  Asked asked;
};

/// Adds to what the sweep tells of kicks.
WEFT_INLINE void tell_kick(KicksAsked kicks, Vec3 kick) {
  store(kicks, larger(dot(kick, kick), load(kicks)));
}
/// Likewise of contact, which moves what is fixed, and what is beside the cloth, only in passing.
WEFT_INLINE void tell_contact(KicksAsked kicks, Mask is_free, Vec3 kick) {
  store(kicks, larger(select(is_free, dot(kick, kick), Vec{}), load(kicks)));
}

/// A vector whose reaction is known and that has yet to move.
struct Waiting {
  float *own = nullptr, *half_velocity = nullptr;  ///< null: there is none; not velocity Verlet
  const float* inverse_mass = nullptr;
  const std::uint32_t* has_fixed = nullptr;
  Side side;  ///< from which it sees the spheres
  alignas(64) float reaction[3 * kLanes] = {};
};

/// Vectors that floor, spheres or bodies may touch: they move once their row is done, for a call amid the
/// springs would cost every vector its registers.
struct PutOff {
  Waiting* list;
  Index count = 0, drifted = 0;  ///< vectors; particles in Bodies::list
};

enum class Contact { put_off, now };

/// docs/float-form.md "Kick and drift" and contact, in place. Gravity and wind are one predicted jump and one
/// addition each, so that they need no variant of their own; nor does velocity Verlet, whose springs see the
/// velocity that it predicts.
template <std::uint32_t kEffects, Contact kWhen = Contact::put_off>
WEFT_INLINE void move(const Acting& acting, const Waiting& waiting, Strides s, PutOff& put_off) {
  if (waiting.own == nullptr) return;
  const Kick& kick = acting.kick;
  const Body own = load_body(waiting.own, s);
  const Vec w = load(waiting.inverse_mass);
  const Vec3 against = w * load3(waiting.reaction, kLanes);
  Vec3 acceleration = acting.outside.has_gravity ? splat3(acting.outside.gravity) - against : -against;
  if (acting.outside.has_wind) acceleration = acceleration + splat3(kick.alpha_wind);
  Vec3 change = splat(kick.gain) * acceleration;
  float* const half = waiting.half_velocity;
  const Vec3 before = half != nullptr && !kick.begins_frame ? load_first(half, s) : own.v;
  if constexpr (kEffects & kAir) change = change - splat(kick.loss) * before;
  Touched next;
  next.v = before + change;
  const Vec3 way = splat(kick.drift) * next.v;
  next.x = own.x + way;
  if constexpr ((kEffects & kContact) && kWhen == Contact::now) {
    touch_all(acting.outside, kick, own.x, next);
    if (acting.asked.bodies)
      touch_bodies(acting.outside, acting.bodies, kick, own.x, w != Vec{}, waiting.own, next,
                   put_off.drifted);
    const Vec3 gone = next.x - own.x;
    if (acting.asked.links && any(~(dot(gone, gone) < splat(acting.asked.leap2)))) *acting.leapt = 1;
    if (acting.kicks != nullptr) {
      tell_contact(acting.kicks, w != Vec{}, next.v - before);
      tell_contact(acting.kicks, w != Vec{}, splat(1.0f / kick.drift) * gone - before);
    }
  }
  if constexpr ((kEffects & kContact) && kWhen == Contact::put_off)
    if (kick.drift > 0.0f &&
        may_be_touched(acting.outside, acting.asked, kick, waiting.side, own.x, way, next.x)) {
      put_off.list[put_off.count++] = waiting;
      return;
    }
  if constexpr ((kEffects & kContact) && kWhen == Contact::put_off)
    if (acting.kicks != nullptr) tell_kick(acting.kicks, change);
  if (half != nullptr) {  // who is let go within a frame goes on from the velocity that its pin had
    store_first(half, s, *waiting.has_fixed ? select(w == Vec{}, own.v, next.v) : next.v);
    Vec3 further = splat(kick.predict_gain) * acceleration;
    if constexpr (kEffects & kAir) further = further - splat(kick.predict_loss) * next.v;
    next.v = next.v + further;
  }
  if (*waiting.has_fixed) {
    const Mask fixed = w == Vec{};
    next.x = select(fixed, own.x, next.x);
    next.v = select(fixed, own.v, next.v);
  }
  store_first(waiting.own, s, next.x);
  store_last(waiting.own, s, next.v);
}

template <std::uint32_t kEffects>
__attribute__((noinline)) void move_put_off(const Acting& acting, Strides s, PutOff& put_off) {
  for (Index k = 0; k < put_off.count; ++k) move<kEffects, Contact::now>(acting, put_off.list[k], s, put_off);
  put_off.count = 0;
  if (put_off.drifted > 0 && acting.asked.links) *acting.leapt = 1;
  if (put_off.drifted > 0)
    acting.bodies.touch_rest(acting.bodies.self, acting.kick, acting.bodies.list, put_off.drifted);
  put_off.drifted = 0;
}

enum class Part { two_above, above, own };

/// One row: the two above a band only leave what reaches into it. A vector moves amid the springs of the next
/// one, which nothing there depends on: its dozen operations each wait for the one before, and by themselves
/// leave the processor idle. Nobody reads it meanwhile.
template <std::uint32_t kEffects, Part kPart>
WEFT_INLINE void sweep_row(const Sweep& sweep, const Acting& acting, Index j, Waiting& waiting,
                           PutOff& put_off) {
  const Sheet& sheet = sweep.sheet;
  FromLeft left;
  Place at{sweep.rows[j] + kColumns, sweep.rows[j + 1] + kColumns, sweep.rows[j + 2] + kColumns,
           sweep.carried + kColumns, Strides(sheet.stride)};
  float* half = sweep.half_velocity;
  if (half != nullptr) half += j * 3 * sheet.stride + kColumns;
  const std::uint32_t* const block_of = sheet.block_of + j * sheet.block_count;
  if constexpr (kPart == Part::own && (kEffects & kContact))
    waiting.side = side_for(acting.kick.clear, at.own, sheet.stride);
  const auto meanwhile = [&] { move<kEffects>(acting, waiting, at.strides, put_off); };
  for (Index b = 0; b < sheet.block_count; ++b) {
    const Block& block = sheet.blocks[block_of[b]];
    for (Index lane = 0; lane < kColumns; lane += kLanes) {
      const Body own = load_body(at.own, at.strides);
      if constexpr (kPart == Part::own) {
        const Vec3 reaction = reaction_of<kEffects>(at, own, block, lane, left, meanwhile);
        store3(waiting.reaction, kLanes, reaction);
        waiting.own = at.own;
        waiting.half_velocity = half;
        waiting.inverse_mass = block.inverse_mass + lane;
        waiting.has_fixed = &block.has_fixed;
        half = half != nullptr ? half + kLanes : nullptr;
      } else {
        if constexpr (kPart == Part::above) springs_down<kEffects>(at, own, block, lane, left);
        if constexpr (kEffects & kTwoApart) spring_two_down<kEffects>(at, own, block, lane);
      }
      at.own += kLanes;
      at.below += kLanes;
      at.below_two += kLanes;
      at.carried += kLanes;
    }
  }
  if constexpr (kPart == Part::own && (kEffects & kContact))
    if (put_off.count > 0) move_put_off<kEffects>(acting, at.strides, put_off);
}

WEFT_INLINE Acting acting_of(const Sweep& sweep) {
  const bool bodies = sweep.bodies.solid_count > 0 || sweep.bodies.has_meshes,
             links = sweep.leap.leapt != nullptr;
  Acting acting{sweep.outside,    *sweep.kick, sweep.bodies,
                sweep.leap.leapt, sweep.kicks, {bodies, links, sweep.leap.leap2}};
  float& leap2 = acting.kick.clear.leap2;
  if (links && sweep.leap.leap2 < leap2) leap2 = sweep.leap.leap2;
  return acting;
}

static_assert(sizeof(Waiting) <= put_off_floats(kLanes) * sizeof(float));

template <std::uint32_t kEffects>
void sweep_rows(const Sweep& sweep) {
  constexpr std::uint32_t kSprings = kEffects & (kDamping | kShear | kTwoApart);
  const Acting acting = acting_of(sweep);
  Waiting waiting;
  PutOff put_off{reinterpret_cast<Waiting*>(sweep.put_off)};
  if (!sweep.goes_on) __builtin_memset(sweep.carried, 0, 6 * sweep.sheet.stride * sizeof(float));
  if (sweep.first > 0 && !sweep.goes_on) {
    if constexpr (kSprings & kTwoApart)
      sweep_row<kSprings, Part::two_above>(sweep, acting, sweep.first - 2, waiting, put_off);
    sweep_row<kSprings, Part::above>(sweep, acting, sweep.first - 1, waiting, put_off);
  }
  for (Index j = sweep.first; j < sweep.last; ++j)
    sweep_row<kEffects, Part::own>(sweep, acting, j, waiting, put_off);
  move<kEffects>(acting, waiting, Strides(sweep.sheet.stride), put_off);
  if constexpr (kEffects & kContact) move_put_off<kEffects>(acting, Strides(sweep.sheet.stride), put_off);
}

/// Sixteen independent chains of 1/√x hide the latency; their sum keeps them alive.
float divide(std::uint64_t repeats) {
  constexpr int kChains = 8;
  Vec chain[kChains];
  for (int c = 0; c < kChains; ++c) chain[c] = splat(1.5f + static_cast<float>(c));
  for (std::uint64_t n = 0; n < repeats; n += kChains)
    for (Vec& link : chain) link = splat(1.0f) / root(link);
  float sum = 0.0f;
  for (const Vec& link : chain) sum += link[0];
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
          look_at_links,
          look_at_motion,
          measure_motion,
          look_how_spread,
          write_places,
          look_at_patches,
          make_near_leaves,
          make_near_levels,
          look_near,
          find_near,
          look_at_surfaces<false>,
          look_at_surfaces<true>,
          xpbd_predict,
          xpbd_finish,
          xpbd_tethers,
          {{pull_along_i<false>, pull_along_j<false, 1>, pull_across<false, false>, pull_across<false, true>,
            pull_two_along_i<false>, pull_along_j<false, 2>, bend_along_i, bend_along_j},
           {pull_along_i<true>, pull_along_j<true, 1>, pull_across<true, false>, pull_across<true, true>,
            pull_two_along_i<true>, pull_along_j<true, 2>, bend_along_i, bend_along_j}},
          divide};
}
