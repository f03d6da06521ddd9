// A strip of columns, marched down row by row with three rows in registers: each spring inside the strip
// is evaluated once, those across its edges twice, and all in the order of docs/float-form.md. The
// including pass defines SOURCE_POSITION(index) and SOURCE_VELOCITY(index), and put(index, position,
// velocity), and includes kick.glsl first. `columns` is a specialization constant, so that every loop over
// columns unrolls and every array becomes registers; arrays have the size of the widest strip because
// indices known at compile time are checked against the size a specialization constant has not got yet.

const uint kMost = 8u;  // columns of the widest strip
const uint kWide = columns + 4u;  // columns -2 … columns + 1 of the row itself
const uint kNear = columns + 2u;  // columns -1 … columns of the row below

// Rows j, j + 1, j + 2 as far as the springs of row j reach; index 0 is the leftmost column of each.
vec3 x_own[kMost + 4u], x_down[kMost + 2u], x_down2[kMost];
vec3 v_own[kMost + 4u], v_down[kMost + 2u], v_down2[kMost];
float w_own[kMost], w_down[kMost], w_down2[kMost];

// Coefficients (K, L, c) by column, zero where there is no such pair: inside and on the first and last row.
vec3 along_inner[kMost + 1u], along_edge[kMost + 1u];    // f10 of columns -1 … columns - 1
vec3 along2_inner[kMost + 2u], along2_edge[kMost + 2u];  // f20 of columns -2 … columns - 1
vec3 shear_k[kMost + 1u];                                  // f11 and fT of columns -1 … columns - 1
bool line_edge[kMost];                                     // whether the column is a boundary line
uint column_of[kMost + 4u];  // that is read for columns -2 … columns + 1: clamped to the cloth

#ifdef LATE_SPHERES
uint late_from, late_to;  // rows whose contact with spheres is to come: from the first to before the second
#endif

vec3 above[kMost];   // P of the row: the forces from the rows above
vec3 f02_up[kMost];  // f02 of the row above

vec3 velocity_if_damped(uint p) { return damping ? SOURCE_VELOCITY(p).xyz : vec3(0.0); }

void prepare_columns(uint first) {
  const int last = int(params.nx) - 1;
  [[unroll]] for (uint c = 0u; c < kWide; ++c) column_of[c] = uint(clamp(int(first + c) - 2, 0, last));
  [[unroll]] for (uint c = 0u; c < columns; ++c) {
    uint i = first + c;
    line_edge[c] = i == 0u || i + 1u >= params.nx;
  }
  [[unroll]] for (uint c = 0u; c <= columns; ++c) {
    bool there = first + c >= 1u && first + c < params.nx;  // the pair of columns first + c - 1 and first + c
    uint i = there ? first + c - 1u : 0u;
    along_inner[c] = there ? row_along_i(i, false, params.nx) : vec3(0.0);
    along_edge[c] = there ? row_along_i(i, true, params.nx) : vec3(0.0);
    shear_k[c] = there ? params.shear.xyz : vec3(0.0);
  }
  [[unroll]] for (uint c = 0u; c < columns + 2u; ++c) {
    bool there = first + c >= 2u && first + c < params.nx;
    along2_inner[c] = there ? params.flex[0].xyz : vec3(0.0);
    along2_edge[c] = there ? params.flex[1].xyz : vec3(0.0);
  }
}

vec3 down_k(uint j, bool edge) {
  vec3 none = edge ? params.structural[9].xyz : params.structural[6].xyz;
  if (!bending) return none;
  vec3 one = edge ? params.structural[10].xyz : params.structural[7].xyz;
  vec3 two = edge ? params.structural[11].xyz : params.structural[8].xyz;
  bool before = j >= 1u, after = j + 2u < params.ny;
  return before && after ? two : (before || after ? one : none);
}

vec3 strip_pair(vec3 k, vec3 xa, vec3 va, vec3 xb, vec3 vb) {
  return pair_force(k, End(xa, va), End(xb, vb));
}

// Loads what row j is the first to reach: its own outermost columns, those of row j + 1, and row j + 2.
void load_reach(uint j) {
  const bool far_pairs = flex || bending;
  uint last = params.ny - 1u, own = j * params.nx, down = min(j + 1u, last) * params.nx;
  uint down2 = min(j + 2u, last) * params.nx;
  if (far_pairs) {
    x_own[0] = SOURCE_POSITION(own + column_of[0]).xyz;
    v_own[0] = velocity_if_damped(own + column_of[0]);
    x_own[kWide - 1u] = SOURCE_POSITION(own + column_of[kWide - 1u]).xyz;
    v_own[kWide - 1u] = velocity_if_damped(own + column_of[kWide - 1u]);
  }
  x_down[0] = SOURCE_POSITION(down + column_of[1]).xyz;
  v_down[0] = velocity_if_damped(down + column_of[1]);
  x_down[kNear - 1u] = SOURCE_POSITION(down + column_of[kNear]).xyz;
  v_down[kNear - 1u] = velocity_if_damped(down + column_of[kNear]);
  [[unroll]] for (uint c = 0u; c < columns; ++c) {
    vec4 x = SOURCE_POSITION(down2 + column_of[c + 2u]);
    x_down2[c] = x.xyz;
    w_down2[c] = x.w;
    v_down2[c] = SOURCE_VELOCITY(down2 + column_of[c + 2u]).xyz;
  }
}

// Row j's rows become row j + 1's.
void shift_down() {
  [[unroll]] for (uint c = 0u; c < kNear; ++c) {
    x_own[c + 1u] = x_down[c];
    v_own[c + 1u] = v_down[c];
  }
  [[unroll]] for (uint c = 0u; c < columns; ++c) {
    w_own[c] = w_down[c];
    x_down[c + 1u] = x_down2[c];
    v_down[c + 1u] = v_down2[c];
    w_down[c] = w_down2[c];
  }
}

// Loads rows j and j + 1 as if row j - 1 had been the last one marched.
void load_start(uint j) {
  uint own = j * params.nx, down = min(j + 1u, params.ny - 1u) * params.nx;
  [[unroll]] for (uint e = 0u; e < kNear; ++e) {
    vec4 x = SOURCE_POSITION(own + column_of[e + 1u]);
    x_own[e + 1u] = x.xyz;
    v_own[e + 1u] = SOURCE_VELOCITY(own + column_of[e + 1u]).xyz;
    if (e >= 1u && e <= columns) w_own[e - 1u] = x.w;
  }
  [[unroll]] for (uint c = 0u; c < columns; ++c) {
    vec4 x = SOURCE_POSITION(down + column_of[c + 2u]);
    x_down[c + 1u] = x.xyz;
    w_down[c] = x.w;
    v_down[c + 1u] = SOURCE_VELOCITY(down + column_of[c + 2u]).xyz;
  }
}

// Evaluates the forces from the rows above row j, once its rows are loaded.
void begin_above(uint j) {
  const vec3 absent = vec3(0.0);
  uint up = (j >= 1u ? j - 1u : j) * params.nx, up2 = (j >= 2u ? j - 2u : 0u) * params.nx;
  bool has_up = j >= 1u, has_up2 = j >= 2u, spans = has_up && j + 1u < params.ny;
  vec3 x_up[kMost + 2u], v_up[kMost + 2u];  // columns -1 … columns of row j - 1
  [[unroll]] for (uint e = 0u; e < kNear; ++e) {
    x_up[e] = SOURCE_POSITION(up + column_of[e + 1u]).xyz;
    v_up[e] = velocity_if_damped(up + column_of[e + 1u]);
  }
  [[unroll]] for (uint c = 0u; c < columns; ++c) {
    uint e = c + 1u, p = up2 + column_of[c + 2u];
    vec3 x = x_own[c + 2u], v = v_own[c + 2u];
    precise vec3 P = absent;
    if (flex || bending) {
      vec3 k02 = line_edge[c] ? params.flex[3].xyz : params.flex[2].xyz;
      P = strip_pair(has_up2 ? k02 : absent, SOURCE_POSITION(p).xyz, velocity_if_damped(p), x, v);
      f02_up[c] = strip_pair(spans ? k02 : absent, x_up[e], v_up[e], x_down[e], v_down[e]);
    }
    P = P + strip_pair(has_up ? down_k(j - 1u, line_edge[c]) : absent, x_up[e], v_up[e], x, v);
    if (shear) {
      P = P + strip_pair(has_up ? shear_k[e] : absent, x_up[e + 1u], v_up[e + 1u], x, v);
      P = P + strip_pair(has_up ? shear_k[c] : absent, x_up[c], v_up[c], x, v);
    }
    above[c] = P;
  }
}

// Forces of row j and the step of its particles; leaves `above` and `f02_up` as row j + 1 needs them.
void step_row(Step s, uint j, uint first) {
  const bool far_pairs = flex || bending;
  const vec3 absent = vec3(0.0);
  bool down = j + 1u < params.ny, down2 = j + 2u < params.ny, edge = j == 0u || !down;
  vec3 k01_inner = down ? down_k(j, false) : absent, k01_edge = down ? down_k(j, true) : absent;
  vec3 k02_inner = down2 ? params.flex[2].xyz : absent, k02_edge = down2 ? params.flex[3].xyz : absent;

  // Of the columns to the left of the strip.
  vec3 f10_left = strip_pair(edge ? along_edge[0] : along_inner[0], x_own[1], v_own[1], x_own[2], v_own[2]);
  vec3 f20_left2 = absent, f20_left = absent, f11_left = absent, fT_left = absent;
  if (far_pairs) {
    f20_left2 = strip_pair(edge ? along2_edge[0] : along2_inner[0], x_own[0], v_own[0], x_own[2], v_own[2]);
    f20_left = strip_pair(edge ? along2_edge[1] : along2_inner[1], x_own[1], v_own[1], x_own[3], v_own[3]);
  }
  if (shear) {
    vec3 k = down ? shear_k[0] : absent;
    f11_left = strip_pair(k, x_own[1], v_own[1], x_down[1], v_down[1]);
    fT_left = strip_pair(k, x_own[2], v_own[2], x_down[0], v_down[0]);
  }
  [[unroll]] for (uint c = 0u; c < columns; ++c) {
    uint o = c + 2u, e = c + 1u;
    vec3 x = x_own[o], v = v_own[o];
    vec3 f01 = strip_pair(line_edge[c] ? k01_edge : k01_inner, x, v, x_down[e], v_down[e]);
    vec3 f10 = strip_pair(edge ? along_edge[e] : along_inner[e], x, v, x_own[o + 1u], v_own[o + 1u]);
    vec3 f11, fT, f20, f02;
#ifdef WEFT_REACH
    look_at_link(x, x_down[e], false);
    look_at_link(x, x_own[o + 1u], false);
#endif
    precise vec3 F = f01 - above[c];
    F = F + f10;
    precise vec3 P = far_pairs ? f02_up[c] + f01 : f01;
    if (shear) {
      vec3 k = down ? shear_k[e] : absent;
      f11 = strip_pair(k, x, v, x_down[e + 1u], v_down[e + 1u]);
      fT = strip_pair(k, x_own[o + 1u], v_own[o + 1u], x_down[e], v_down[e]);
      precise vec3 difference = fT_left - f10_left;
      F = F + difference;
#ifdef WEFT_REACH
      look_at_link(x, x_down[e + 1u], true);
      look_at_link(x_own[o + 1u], x_down[e], true);
#endif
      F = F + f11;
      P = P + fT;
      P = P + f11_left;
      f11_left = f11;
      fT_left = fT;
    } else {
      F = F - f10_left;
    }
    if (far_pairs) {
      f20 = strip_pair(edge ? along2_edge[o] : along2_inner[o], x, v, x_own[o + 2u], v_own[o + 2u]);
      f02 = strip_pair(line_edge[c] ? k02_edge : k02_inner, x, v, x_down2[c], v_down2[c]);
      F = F + f20;
      F = F - f20_left2;
      F = F + f02;
      f20_left2 = f20_left;
      f20_left = f20;
      f02_up[c] = f02;
    }
    above[c] = P;
    f10_left = f10;
    if (first + c < params.nx) {
      step_particle(s, F, w_own[c], x, v);
      put(j * params.nx + first + c, vec4(x, w_own[c]), vec4(v, near_sphere ? 1.0 : 0.0));
#ifdef LATE_SPHERES
      late_from = near_sphere ? min(late_from, j) : late_from;
      late_to = near_sphere ? j + 1u : late_to;
#endif
    }
  }
}

#ifdef LATE_SPHERES
// Contact of the particles that step_row() marked, in a loop of its own: no row is in registers any more.
void touch_late(Step s, uint first) {
  uint count = late_from < late_to ? (late_to - late_from) * columns : 0u;
  for (uint k = 0u; k < count; ++k) {
    uint i = first + k % columns, p = (late_from + k / columns) * params.nx + i;
    if (i < params.nx && velocity_next[p].w != 0.0) {
      vec3 x0 = SOURCE_POSITION(p).xyz, v = velocity_next[p].xyz;
      vec4 x1 = position_next[p];
      contact(s.row, x0, x1.xyz, v);
#ifdef WEFT_REACH
      look_for_bodies(x0, x1.xyz);
#endif
#ifdef WEFT_SPREAD
      look_at_kick(s.drift, x0, SOURCE_VELOCITY(p).xyz, x1.xyz, v);
#endif
      put(p, x1, vec4(v, 0.0));
    }
  }
}
#endif

// Marches the strip whose leftmost column is `first` over rows [begin, end).
void march_strip(Step s, uint first, uint begin, uint end) {
#ifdef LATE_SPHERES
  late_from = 0xffffffffu;
  late_to = 0u;
#endif
  load_start(begin);
  begin_above(begin);
  for (uint j = begin; j < end; ++j) {
    load_reach(j);
    step_row(s, j, first);
    shift_down();
  }
#ifdef LATE_SPHERES
  if (late_spheres) touch_late(s, first);
#endif
}
