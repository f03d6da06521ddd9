// XPBD's colours of springs and triples, operation by operation as docs/solvers.md "xpbd". A colour's springs
// share no particle: those along j lie in vectors as they are, the others are sorted out of two or three
// vectors and put back. Included by kernel_text.h.

/// Column `lane` of part `part`, of kParts·kLanes columns that stand side by side.
struct EverySecond {
  static constexpr int kParts = 2;
  static constexpr int column(int part, int lane) { return 2 * lane + part; }
  static constexpr int part(int column) { return column % 2; }
  static constexpr int lane(int column) { return column / 2; }
};
/// Two columns, then the two after them.
struct PairsOfTwo {
  static constexpr int kParts = 2;
  static constexpr int column(int part, int lane) { return 4 * (lane / 2) + 2 * part + lane % 2; }
  static constexpr int part(int column) { return column / 2 % 2; }
  static constexpr int lane(int column) { return column / 4 * 2 + column % 2; }
};
struct EveryThird {
  static constexpr int kParts = 3;
  static constexpr int column(int part, int lane) { return 3 * lane + part; }
  static constexpr int part(int column) { return column % 3; }
  static constexpr int lane(int column) { return column / 3; }
};

template <int... kLane>
struct LaneList {};
template <int kCount, int... kLane>
struct LanesUpTo : LanesUpTo<kCount - 1, kCount - 1, kLane...> {};
template <int... kLane>
struct LanesUpTo<0, kLane...> {
  using List = LaneList<kLane...>;
};
constexpr LanesUpTo<kLanes>::List kEveryLane{};

template <class Order, int kPart, int... k>
WEFT_INLINE Vec sorted_out(const Vec (&side)[Order::kParts], LaneList<k...>) {
  if constexpr (Order::kParts == 2) {
    return __builtin_shufflevector(side[0], side[1], Order::column(kPart, k)...);
  } else {
    const Vec near = __builtin_shufflevector(
        side[0], side[1], (Order::column(kPart, k) < 2 * kLanes ? Order::column(kPart, k) : 0)...);
    return __builtin_shufflevector(
        near, side[2], (Order::column(kPart, k) < 2 * kLanes ? k : Order::column(kPart, k) - kLanes)...);
  }
}

template <class Order, int kSide, int... k>
WEFT_INLINE Vec put_back(const Vec (&part)[Order::kParts], LaneList<k...>) {
  constexpr int c = kSide * kLanes;
  if constexpr (Order::kParts == 2) {
    return __builtin_shufflevector(part[0], part[1], (Order::part(c + k) * kLanes + Order::lane(c + k))...);
  } else {
    const Vec near = __builtin_shufflevector(
        part[0], part[1], (Order::part(c + k) < 2 ? Order::part(c + k) * kLanes + Order::lane(c + k) : 0)...);
    return __builtin_shufflevector(near, part[2],
                                   (Order::part(c + k) < 2 ? k : kLanes + Order::lane(c + k))...);
  }
}

/// Some columns of one row array, sorted.
template <class Order>
struct Sorted {
  Vec part[Order::kParts];
  WEFT_INLINE void load_from(const float* from) {
    Vec side[Order::kParts];
    for (int s = 0; s < Order::kParts; ++s) side[s] = load(from + s * kLanes);
    part[0] = sorted_out<Order, 0>(side, kEveryLane);
    part[1] = sorted_out<Order, 1>(side, kEveryLane);
    if constexpr (Order::kParts == 3) part[2] = sorted_out<Order, 2>(side, kEveryLane);
  }
  WEFT_INLINE void store_to(float* to) const {
    store(to, put_back<Order, 0>(part, kEveryLane));
    store(to + kLanes, put_back<Order, 1>(part, kEveryLane));
    if constexpr (Order::kParts == 3) store(to + 2 * kLanes, put_back<Order, 2>(part, kEveryLane));
  }
};
template <class Order>
struct Sorted3 {
  Sorted<Order> x, y, z;
  WEFT_INLINE void load_from(const float* from, Index stride) {
    x.load_from(from);
    y.load_from(from + stride);
    z.load_from(from + 2 * stride);
  }
  WEFT_INLINE void store_to(float* to, Index stride) const {
    x.store_to(to);
    y.store_to(to + stride);
    z.store_to(to + 2 * stride);
  }
  WEFT_INLINE Vec3 part(int p) const { return {x.part[p], y.part[p], z.part[p]}; }
  WEFT_INLINE void set(int p, Vec3 v) { x.part[p] = v.x, y.part[p] = v.y, z.part[p] = v.z; }
};

/// The column in which the particle of each lane stands, counted from the first one of its vectors.
template <class Order>
WEFT_INLINE Mask columns_of(int part) {
  Mask columns{};
  for (int lane = 0; lane < kLanes; ++lane) columns[lane] = Order::column(part, lane);
  return columns;
}
WEFT_INLINE Mask columns_side_by_side() {
  Mask columns{};
  for (int lane = 0; lane < kLanes; ++lane) columns[lane] = lane;
  return columns;
}

struct Stiffness {
  Vec rest, stiff, gamma;
};
/// α = C·(ν·ν) and γ = β·ν of a substep.
WEFT_INLINE Stiffness stiffness_of(const XpbdPull& pull, float compliance) {
  const float rate = 1.0f / pull.step;
  return {splat(pull.rest), splat(compliance * (rate * rate)), splat(pull.damping_time * rate)};
}

struct Ends {
  Vec3 xa, xb, ma, mb;
  Vec wa, wb;
};
template <bool kDamped>
WEFT_INLINE void pull_ends(Ends& e, const Stiffness& s, Mask exists) {
  const Vec w = e.wa + e.wb;
  const Vec3 moved = e.mb - e.ma, d = (e.xb - e.xa) + moved;
  const Vec l = root(larger(dot(d, d), splat(kTinyLengthSquared)));
  const Vec3 n = (splat(1.0f) / l) * d;
  Vec error = l - s.rest, weight = w;
  if constexpr (kDamped) {
    error = error + s.gamma * dot(n, moved);
    weight = (splat(1.0f) + s.gamma) * w;
  }
  const Vec3 push = (error / (weight + s.stiff)) * n;
  const Mask pulls = exists & (w != Vec{});
  e.ma = select(pulls, e.ma + e.wa * push, e.ma);
  e.mb = select(pulls, e.mb - e.wb * push, e.mb);
}

/// Row j at column i of the state, and of what has moved.
WEFT_INLINE float* state_at(const XpbdSheet& sheet, Index j, Index i) {
  return sheet.state + j * 6 * sheet.stride + kColumns + i;
}
WEFT_INLINE float* moved_at(const XpbdSheet& sheet, Index j, Index i) {
  return sheet.moved + j * 4 * sheet.stride + kColumns + i;
}

/// Springs within a row, whose ends are the two parts of an order.
template <bool kDamped, class Order>
WEFT_INLINE void pull_in_row(const XpbdPull& pull, Index j, Index first) {
  const XpbdSheet& sheet = pull.sheet;
  const bool on_edge = j == 0 || j + 1 == sheet.ny;
  const Stiffness s = stiffness_of(pull, on_edge ? pull.compliance_edge : pull.compliance);
  const Mask last = columns_of<Order>(1);
  for (Index i = first; i < sheet.nx; i += 2 * kLanes) {
    Sorted3<Order> x, m;
    Sorted<Order> w;
    float* const moved = moved_at(sheet, j, i);
    x.load_from(state_at(sheet, j, i), sheet.stride);
    m.load_from(moved, sheet.stride);
    w.load_from(moved + 3 * sheet.stride);
    Ends e{x.part(0), x.part(1), m.part(0), m.part(1), w.part[0], w.part[1]};
    pull_ends<kDamped>(e, s, last < static_cast<int>(sheet.nx - i));
    m.set(0, e.ma);
    m.set(1, e.mb);
    m.store_to(moved, sheet.stride);
  }
}
template <bool kDamped>
void pull_along_i(const XpbdPull& pull) {
  for (Index j = pull.first; j < pull.last; ++j) pull_in_row<kDamped, EverySecond>(pull, j, pull.colour);
}
template <bool kDamped>
void pull_two_along_i(const XpbdPull& pull) {
  for (Index j = pull.first; j < pull.last; ++j) pull_in_row<kDamped, PairsOfTwo>(pull, j, 2 * pull.colour);
}

/// Springs from row to row; kReach rows down.
template <bool kDamped, int kReach>
void pull_along_j(const XpbdPull& pull) {
  const XpbdSheet& sheet = pull.sheet;
  const Stiffness inside = stiffness_of(pull, pull.compliance),
                  edge = stiffness_of(pull, pull.compliance_edge);
  const Mask lanes = columns_side_by_side();
  for (Index j = pull.first; j < pull.last && j + kReach < sheet.ny; ++j) {
    if (j / kReach % 2 != pull.colour) continue;
    for (Index i = 0; i < sheet.nx; i += kLanes) {
      float *const a = moved_at(sheet, j, i), *const b = moved_at(sheet, j + kReach, i);
      const Mask column = lanes + static_cast<int>(i);
      const Mask on_edge = (column == 0) | (column == static_cast<int>(sheet.nx - 1));
      const Stiffness s{inside.rest, select(on_edge, edge.stiff, inside.stiff), inside.gamma};
      Ends e{load3(state_at(sheet, j, i), sheet.stride),
             load3(state_at(sheet, j + kReach, i), sheet.stride),
             load3(a, sheet.stride),
             load3(b, sheet.stride),
             load(a + 3 * sheet.stride),
             load(b + 3 * sheet.stride)};
      pull_ends<kDamped>(e, s, column < static_cast<int>(sheet.nx));
      store3(a, sheet.stride, e.ma);
      store3(b, sheet.stride, e.mb);
    }
  }
}

/// Diagonals: from (i, j) to (i+1, j+1), or rising from (i+1, j) to (i, j+1); i of one parity.
template <bool kDamped, bool kRising>
void pull_across(const XpbdPull& pull) {
  using Order = EverySecond;
  constexpr int kA = kRising ? 1 : 0, kB = 1 - kA;
  const XpbdSheet& sheet = pull.sheet;
  const Stiffness s = stiffness_of(pull, pull.compliance);
  const Mask last = columns_of<Order>(1);
  for (Index j = pull.first; j < pull.last && j + 1 < sheet.ny; ++j) {
    for (Index i = pull.colour; i < sheet.nx; i += 2 * kLanes) {
      Sorted3<Order> xa, xb, ma, mb;
      Sorted<Order> wa, wb;
      float *const a = moved_at(sheet, j, i), *const b = moved_at(sheet, j + 1, i);
      xa.load_from(state_at(sheet, j, i), sheet.stride);
      xb.load_from(state_at(sheet, j + 1, i), sheet.stride);
      ma.load_from(a, sheet.stride);
      mb.load_from(b, sheet.stride);
      wa.load_from(a + 3 * sheet.stride);
      wb.load_from(b + 3 * sheet.stride);
      Ends e{xa.part(kA), xb.part(kB), ma.part(kA), mb.part(kB), wa.part[kA], wb.part[kB]};
      pull_ends<kDamped>(e, s, last < static_cast<int>(sheet.nx - i));
      ma.set(kA, e.ma);
      mb.set(kB, e.mb);
      ma.store_to(a, sheet.stride);
      mb.store_to(b, sheet.stride);
    }
  }
}

WEFT_INLINE Vec3 second_difference(Vec3 a, Vec3 b, Vec3 c) { return (a - splat(2.0f) * b) + c; }

struct Triple {
  Vec3 xa, xb, xc, ma, mb, mc;
  Vec wa, wb, wc;
};
WEFT_INLINE void straighten(Triple& t, Vec stiff, Mask exists) {
  const Vec w = (t.wa + splat(4.0f) * t.wb) + t.wc;
  const Vec3 off = second_difference(t.xa, t.xb, t.xc) + second_difference(t.ma, t.mb, t.mc);
  const Vec whole = w + stiff;
  const Vec3 push{off.x / whole, off.y / whole, off.z / whole};
  const Mask pulls = exists & (w != Vec{});
  t.ma = select(pulls, t.ma - t.wa * push, t.ma);
  t.mb = select(pulls, t.mb + (splat(2.0f) * t.wb) * push, t.mb);
  t.mc = select(pulls, t.mc - t.wc * push, t.mc);
}

void bend_along_i(const XpbdPull& pull) {
  using Order = EveryThird;
  const XpbdSheet& sheet = pull.sheet;
  const Mask last = columns_of<Order>(2);
  for (Index j = pull.first; j < pull.last; ++j) {
    const bool on_edge = j == 0 || j + 1 == sheet.ny;
    const Vec stiff = stiffness_of(pull, on_edge ? pull.compliance_edge : pull.compliance).stiff;
    for (Index i = pull.colour; i < sheet.nx; i += 3 * kLanes) {
      Sorted3<Order> x, m;
      Sorted<Order> w;
      float* const moved = moved_at(sheet, j, i);
      x.load_from(state_at(sheet, j, i), sheet.stride);
      m.load_from(moved, sheet.stride);
      w.load_from(moved + 3 * sheet.stride);
      Triple t{x.part(0), x.part(1), x.part(2), m.part(0), m.part(1),
               m.part(2), w.part[0], w.part[1], w.part[2]};
      straighten(t, stiff, last < static_cast<int>(sheet.nx - i));
      m.set(0, t.ma);
      m.set(1, t.mb);
      m.set(2, t.mc);
      m.store_to(moved, sheet.stride);
    }
  }
}

void bend_along_j(const XpbdPull& pull) {
  const XpbdSheet& sheet = pull.sheet;
  const Vec inside = stiffness_of(pull, pull.compliance).stiff,
            edge = stiffness_of(pull, pull.compliance_edge).stiff;
  const Mask lanes = columns_side_by_side();
  for (Index j = pull.first; j < pull.last && j + 2 < sheet.ny; ++j) {
    if (j % 3 != pull.colour) continue;
    for (Index i = 0; i < sheet.nx; i += kLanes) {
      const Mask column = lanes + static_cast<int>(i);
      const Mask on_edge = (column == 0) | (column == static_cast<int>(sheet.nx - 1));
      float* rows[3];
      for (Index r = 0; r < 3; ++r) rows[r] = moved_at(sheet, j + r, i);
      const auto x = [&](Index r) { return load3(state_at(sheet, j + r, i), sheet.stride); };
      const auto w = [&](Index r) { return load(rows[r] + 3 * sheet.stride); };
      Triple t{x(0),
               x(1),
               x(2),
               load3(rows[0], sheet.stride),
               load3(rows[1], sheet.stride),
               load3(rows[2], sheet.stride),
               w(0),
               w(1),
               w(2)};
      straighten(t, select(on_edge, edge, inside), column < static_cast<int>(sheet.nx));
      store3(rows[0], sheet.stride, t.ma);
      store3(rows[1], sheet.stride, t.mb);
      store3(rows[2], sheet.stride, t.mc);
    }
  }
}

/// h·kick(v, acceleration without springs).
void xpbd_predict(const XpbdMove& move) {
  const XpbdSheet& sheet = move.sheet;
  const Kick& kick = *move.kick;
  Vec3 acceleration{};
  if (move.outside.has_gravity) acceleration = acceleration + splat3(move.outside.gravity);
  if (move.outside.has_wind) acceleration = acceleration + splat3(kick.alpha_wind);
  const Vec3 gained = splat(kick.gain) * acceleration;
  for (Index j = move.first; j < move.last; ++j) {
    for (Index i = 0; i < sheet.nx; i += kLanes) {
      float* const moved = moved_at(sheet, j, i);
      const Vec3 v = load3(state_at(sheet, j, i) + 3 * sheet.stride, sheet.stride);
      const Vec3 change = move.has_air ? gained - splat(kick.loss) * v : gained;
      const Vec3 way = splat(kick.drift) * (v + change);
      const Mask fixed = load(moved + 3 * sheet.stride) == Vec{};
      store3(moved, sheet.stride, select(fixed, Vec3{}, way));
    }
  }
}

void xpbd_tethers(const XpbdTethers& t) {
  const XpbdSheet& sheet = t.sheet;
  for (Index j = t.first; j < t.last; ++j)
    for (Index b = 0; b < t.blocks; ++b) {
      const Index anchor = t.anchors[j * t.blocks + b];
      const bool one = anchor < t.no_anchor;
      if (!one && t.several == nullptr) continue;
      const auto same = [](const float* at) { return Vec3{splat(at[0]), splat(at[1]), splat(at[2])}; };
      Vec3 from{}, with{};  // who hangs from several hangs from those that stand still
      if (one) from = same(t.places + 6 * anchor), with = same(t.places + 6 * anchor + 3);
      for (Index i = kColumns * b; i < kColumns * (b + 1); i += kLanes) {
        float* const moved = moved_at(sheet, j, i);
        if (!one)
          from = load3(t.several + 3 * kColumns * (anchor - t.no_anchor) + (i - kColumns * b), kColumns);
        const Vec reach = load(t.reach + j * sheet.stride + i);
        const Vec3 m = load3(moved, sheet.stride),
                   d = (load3(state_at(sheet, j, i), sheet.stride) - from) + (m - with);
        const Vec q = dot(d, d);
        const Mask pulled =
            (q > reach * reach) & (reach >= Vec{}) & (load(moved + 3 * sheet.stride) != Vec{});
        if (!any(pulled)) continue;
        const Vec l = root(q), share = (l - reach) * (splat(1.0f) / l);
        store3(moved, sheet.stride, select(pulled, m - share * d, m));
      }
    }
}

void xpbd_finish(const XpbdMove& move) {
  const XpbdSheet& sheet = move.sheet;
  const Kick& kick = *move.kick;
  const Vec drift = splat(kick.drift);
  const bool has_bodies = move.bodies.solid_count > 0 || move.bodies.has_meshes != 0;
  for (Index j = move.first; j < move.last; ++j) {
    Index listed = 0;
    for (Index i = 0; i < sheet.nx; i += kLanes) {
      float* const state = state_at(sheet, j, i);
      const float* const moved = moved_at(sheet, j, i);
      const Vec3 x = load3(state, sheet.stride), v = load3(state + 3 * sheet.stride, sheet.stride);
      const Vec3 m = load3(moved, sheet.stride);
      Touched next{x + m, {m.x / drift, m.y / drift, m.z / drift}};
      if (move.has_contact) next = touch(move.outside, kick, x, next);
      const Mask fixed = load(moved + 3 * sheet.stride) == Vec{};
      if (has_bodies) touch_bodies(move.outside, move.bodies, kick, x, ~fixed, state, next, listed);
      store3(state, sheet.stride, select(fixed, x, next.x));
      store3(state + 3 * sheet.stride, sheet.stride, select(fixed, v, next.v));
    }
    if (listed > 0) move.bodies.touch_rest(move.bodies.self, kick, move.bodies.list, listed);
  }
}
