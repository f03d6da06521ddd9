#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "../shared/pass.glsl"

// A look at a cloth with self-collision that may be spread out over a plane, nowhere folded: by which margins
// it is, and how it moves. Integers alone, bits of largest values, so that no order matters. Each workgroup
// finds its own largest first. Source: docs/float-form.md "Spread".

#include "../shared/spread.h"
#include "../shared/collision.h"
#include "../shared/dot.glsl"
READS_VECTORS(position)
READS_VECTORS(velocity)
READS_VECTORS(velocity_next)
UPDATES(uint, spread_state)

layout(local_size_x = 64) in;

#include "../shared/held_params.glsl"

shared uint found[kSpreadFoundCount];
shared uint found_short;
float least[kSpreadMargins], local_least[kSpreadMargins];  // how far cells have to go [m], read once
float strict;  // of local_least, for the widest margin that is asked for
uint margins;  // a bit for each that is

vec3 said(uint word) {
  return vec3(uintBitsToFloat(spread_state[word]), uintBitsToFloat(spread_state[word + 1u]),
              uintBitsToFloat(spread_state[word + 2u]));
}
void say(uint word, vec3 v) {
  for (uint axis = 0u; axis < 3u; ++axis) spread_state[word + axis] = floatBitsToUint(v[axis]);
}

vec3 place(uint i, uint j) { return load_position(j * params.nx + i).xyz; }
vec3 speed(uint i, uint j) { return load_velocity(j * params.nx + i).xyz; }

struct Frame {
  vec3 along, down;
};

// Two unit vectors at right angles, as near as they come to these two: docs/float-form.md "Folds".
Frame frame_of(vec3 along, vec3 down) {
  precise vec3 a = along * (1.0 / sqrt(dot3(along, along))), b = down * (1.0 / sqrt(dot3(down, down)));
  precise vec3 sum = a + b, rest = a - b;
  precise vec3 u = sum * (kHalfRoot / sqrt(dot3(sum, sum))), w = rest * (kHalfRoot / sqrt(dot3(rest, rest)));
  precise vec3 first = u + w, second = u - w;
  return Frame(first, second);
}

// A triangle's edges along and down as a frame has them: the symmetric part's diagonal, and what is off it.
vec3 slope_of(Frame frame, vec3 along, vec3 down) {
  precise float m = 0.5 * (dot3(frame.along, down) + dot3(frame.down, along));
  return vec3(dot3(frame.along, along), dot3(frame.down, down), m);
}

// Whether no direction on the cloth goes on by less than `by` a cell.
bool goes_along(vec3 slope, float by) {
  precise float a = slope.x - by, b = slope.y - by;
  precise float both = a * b, off = slope.z * slope.z;
  return a >= 0.0 && b >= 0.0 && both >= off;
}

struct Cell {
  vec3 top, side, bottom, far;  // edges: along of both rows, down of both columns
};
Cell cell_at(vec3 here, vec3 right, vec3 under, vec3 across) {
  precise vec3 top = right - here, side = under - here, bottom = across - under, far = across - right;
  return Cell(top, side, bottom, far);
}

// Of the margins in `asked`, those by which the cell is not spread in the frame.
uint short_in(Frame frame, Cell cell, float by[kSpreadMargins], uint asked) {
  vec3 above = slope_of(frame, cell.top, cell.side), below = slope_of(frame, cell.bottom, cell.far);
  uint fails = 0u;
  [[unroll]] for (uint margin = 0u; margin < kSpreadMargins; ++margin)
    fails |= goes_along(above, by[margin]) && goes_along(below, by[margin]) ? 0u : 1u << margin;
  return fails & asked;
}

// The same in the frame of the nine cells round it; where the cloth ends its last particles stand again.
uint short_locally(uint i, uint j, uint asked) {
  uint i0 = max(i, 1u) - 1u, j0 = max(j, 1u) - 1u;
  uint i1 = min(i + 2u, params.nx - 1u), j1 = min(j + 2u, params.ny - 1u);
  vec3 first = place(i0, j0), beyond = place(i1, j0), under = place(i0, j1), last = place(i1, j1);
  precise vec3 along = (beyond - first) + (last - under), down = (under - first) + (last - beyond);
  Frame frame = frame_of(along, down);
  uint fails = 0u;
  [[dont_unroll]] for (uint y = j0; y < j1; ++y)
    [[dont_unroll]] for (uint x = i0; x < i1; ++x) {
      Cell cell = cell_at(place(x, y), place(x + 1u, y), place(x, y + 1u), place(x + 1u, y + 1u));
      fails |= short_in(frame, cell, local_least, asked);
    }
  return fails;
}

// Of all margins, those by which cell (i, j) is not spread. Cells that go along the plane by the widest one,
// as they must along their surroundings, are spread by all and not asked.
uint short_at(Frame plane, uint i, uint j) {
  Cell cell = cell_at(place(i, j), place(i + 1u, j), place(i, j + 1u), place(i + 1u, j + 1u));
  uint asked = short_in(plane, cell, local_least, margins), fails = short_in(plane, cell, least, asked);
  uint rest = asked & ~fails;
  return rest == 0u ? fails : fails | short_locally(i, j, rest);
}

// What the next frame chooses its plane by.
void sample_borders() {
  precise vec3 along = vec3(0.0), down = vec3(0.0);
  uint last = params.nx - 1u, bottom = params.ny - 1u;
  for (uint k = 0u; k < kSpreadSamples; ++k) {
    uint j = k * bottom / (kSpreadSamples - 1u), i = k * last / (kSpreadSamples - 1u);
    precise vec3 across = place(last, j) - place(0u, j), fall = place(i, bottom) - place(i, 0u);
    along = along + across;
    down = down + fall;
  }
  say(kSpreadAlong, along);
  say(kSpreadDown, down);
  say(kSpreadMiddle, speed(params.nx / 2u, params.ny / 2u));
}

struct Look {
  float apart2, speed2, place2, longest2, kick2;
  uint fails;
};

float larger(float a, float b) { return a > b ? a : b; }

// Marches down rows [first, end) of column i, with what two rows share in registers. Few cells do not go
// along the plane: those wait, since devices that run invocations in step pay for what any does.
Look march(Frame plane, vec3 shared_v, uint i, uint first, uint end) {
  Look look = Look(0.0, 0.0, 0.0, 0.0, 0.0, 0u);
  bool has_right = i + 1u < params.nx;
  uint right = has_right ? i + 1u : i, waiting = 0u;
  vec3 x = place(i, first), x_right = place(right, first), v = speed(i, first);
  for (uint j = first; j < end; ++j) {
    bool has_below = j + 1u < params.ny;
    uint below = has_below ? j + 1u : j;
    vec3 x_below = place(i, below), x_far = place(right, below), v_below = speed(i, below);
    Cell cell = cell_at(x, x_right, x_below, x_far);
    precise vec3 own_v = v - shared_v, along_v = speed(right, j) - v, down_v = v_below - v;
    precise vec3 kick = v - load_velocity_next(j * params.nx + i).xyz;
    float place2 = dot3(x, x), speed2 = dot3(own_v, own_v);
    float along2 = dot3(along_v, along_v), down2 = dot3(down_v, down_v);
    precise float all = (place2 + speed2) + (along2 + down2);
    look.fails = (floatBitsToUint(all) & 0x7fffffffu) >= kInfinity ? margins : look.fails;  // no number
    look.place2 = larger(place2, look.place2);
    look.speed2 = larger(speed2, look.speed2);
    look.apart2 = larger(larger(along2, down2), look.apart2);
    look.longest2 = larger(larger(dot3(cell.top, cell.top), dot3(cell.side, cell.side)), look.longest2);
    look.kick2 = larger(dot3(kick, kick), look.kick2);
    bool goes = goes_along(slope_of(plane, cell.top, cell.side), strict) &&
                goes_along(slope_of(plane, cell.bottom, cell.far), strict);
    waiting |= has_right && has_below && !goes ? 1u << (j - first) : 0u;
    x = x_below;
    x_right = x_far;
    v = v_below;
  }
  for (; waiting != 0u; waiting &= waiting - 1u)
    look.fails |= short_at(plane, i, first + uint(findLSB(waiting)));
  return look;
}

void main() {
  hold_params();
  uint lane = gl_LocalInvocationIndex, i = gl_GlobalInvocationID.x;
  uint first = gl_GlobalInvocationID.y * kSpreadRows;
  if (lane < kSpreadFoundCount) found[lane] = 0u;
  if (lane == 0u) found_short = 0u;
  barrier();
  if (i < params.nx && first < params.ny) {
    Frame plane = Frame(said(kSpreadAxis1), said(kSpreadAxis2));
    [[unroll]] for (uint margin = 0u; margin < kSpreadMargins; ++margin) {
      least[margin] = uintBitsToFloat(spread_state[kSpreadLeast + margin]);
      local_least[margin] = uintBitsToFloat(spread_state[kSpreadLocalLeast + margin]);
    }
    uint widest = spread_state[kSpreadFirst];
    strict = uintBitsToFloat(spread_state[kSpreadLocalLeast + widest]);
    margins = (1u << kSpreadMargins) - (1u << widest);
    Look look = march(plane, said(kSpreadShared), i, first, min(first + kSpreadRows, params.ny));
    atomicMax(found[kSpreadApart2 - kSpreadFound], floatBitsToUint(look.apart2));
    atomicMax(found[kSpreadSpeed2 - kSpreadFound], floatBitsToUint(look.speed2));
    atomicMax(found[kSpreadPlace2 - kSpreadFound], floatBitsToUint(look.place2));
    atomicMax(found[kSpreadLongest2 - kSpreadFound], floatBitsToUint(look.longest2));
    atomicMax(found[kSpreadKick2 - kSpreadFound], floatBitsToUint(look.kick2));
    if (look.fails != 0u) atomicOr(found_short, look.fails);
    if (i == 0u && first == 0u) sample_borders();
  }
  barrier();
  if (lane < kSpreadFoundCount) atomicMax(spread_state[kSpreadFound + lane], found[lane]);
  if (lane == 0u && found_short != 0u) atomicOr(spread_state[kSpreadShort], found_short);
}
