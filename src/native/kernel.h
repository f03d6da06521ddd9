// What a vector kernel reads and writes, as plain data: the files that implement it are compiled for
// instructions that this machine may not have, so that they may share no inline function with the others.
#pragma once
#include <cstddef>
#include <cstdint>

namespace weft::native {

/// Floats of the widest vector. Rows, blocks and pads are multiples of it, whatever the kernel's width.
inline constexpr std::size_t kColumns = 16;

/// A pair's K, L and c by column, as docs/float-form.md has them; 0 where the pair does not exist.
struct PairColumns {
  float k[kColumns], l[kColumns], c[kColumns];
};

/// The pairs of a particle by its place in Block::pairs, in the order in which the sweep evaluates them.
enum PairName { kPair01, kPairT, kPair10, kPair11, kPair20, kPair02, kPairCount };

/// Everything immutable about sixteen particles of a row.
struct alignas(64) Block {
  PairColumns pairs[kPairCount];
  float inverse_mass[kColumns];  ///< [1/kg]; 0: pinned, or beyond the cloth
  std::uint32_t has_fixed;       ///< whether any inverse mass is 0
};

/// One sphere during one drift [m, m/s].
struct Sphere {
  float center[3], travel[3], velocity[3];
  float reach, friction;
};

/// One pin that moves or lets go, during one drift: how far it is from where it held first [m], its velocity
/// [m/s], and whether it has let go before.
struct PinPlace {
  float offset[3], velocity[3];
  std::uint32_t released;
};

/// One capsule or box during one drift; passes/coefficients.h "SolidRow" says what each is.
struct Solid {
  float center[3], start[3], velocity[3], spin[3], half[3];
  float axes[3][3], start_axes[3][3];
  float reach, deep, friction;
};

/// What [aerodynamics] does during one kick; passes/coefficients.h "AirRow" says what each is.
struct Air {
  float wind[3], origin[3];
  float cells_1_m, slice_share, noise_m_s, drag, lift;
  std::uint32_t slice, seed, has_noise;
  float noise_farthest;             ///< cells, as shared/params.h
  std::uint32_t noise_period_mask;  ///< cells
};

/// Where no sphere and no body is in one drift: a particle that is beyond the box on one side where the drift
/// begins and where it ends, and goes less than `leap`, is touched by none.
struct Clear {
  float low[3], high[3];  ///< round all of them all the while, and some more [m]
  float leap2;            ///< its square [m²]; negative: spheres go too far themselves
};

/// What of a drift may touch a body: passes/reach.h "ReachRow".
struct Near {
  float low[3], high[3], leap;  ///< [m]
};

/// One row of the schedule, rounded once; passes/coefficients.h says what each is.
struct Kick {
  float alpha_wind[3], loss, gain, drift;
  float predict_loss, predict_gain;  ///< of the kick that predicts; 0 without one
  std::uint32_t begins_frame;        ///< the frame's first row
  const Sphere* spheres;             ///< Outside::sphere_count of them
  const Solid *solids, *meshes;      ///< capsules and boxes; meshes
  Clear clear;                       ///< of all whose contact is the sweep's
  Near near;                         ///< the bodies of these
  const PinPlace* pins;              ///< as Model::moved_pins
  const Air* air;                    ///< null without [aerodynamics]
};

/// What acts on every particle alike.
struct Outside {
  float gravity[3];
  float floor_height, floor_friction;
  std::uint32_t has_gravity, has_wind, has_floor, sphere_count;
};

/// The cloth's rows. A row is x[stride] y[stride] z[stride] vx[stride] vy[stride] vz[stride], and column i is
/// at kColumns + i: a pad of sixteen finite floats stands on either side.
struct Sheet {
  std::size_t stride, block_count;
  const Block* blocks;
  const std::uint32_t* block_of;  ///< by row and block
};

/// A particle whose contact vectors do not compute.
struct Drifted {
  float* at;           ///< its column of the row
  float from[3];       ///< where its drift began [m]
  std::uint32_t deep;  ///< whether capsules and boxes come first: its path may have gone deep
};

/// Bodies whose contact is the sweep's, right after the drift.
struct Bodies {
  std::uint32_t solid_count, has_meshes;
  Drifted* list;  ///< room for those of a row and of one vector more
  void (*touch_rest)(const void* self, const Kick& kick, const Drifted* list, std::size_t count);
  const void* self;
};

/// What the sweep tells of ways: native/leap_watch.h.
struct LeapAsked {
  float leap2;           ///< [m²]
  std::uint32_t* leapt;  ///< set where a particle goes so far; null: nobody asks
};

/// What the sweep tells of kicks, plan/spread_watch.h: raised to the squares [m²/s²] of how much velocities
/// change in a substep, and of how far ways are from those of the velocities before, per second; kColumns of
/// them, at a multiple of 64 bytes. Null: nobody asks.
using KicksAsked = float*;

/// One sweep over rows [first, last): kick and drift, in place.
struct Sweep {
  Sheet sheet;
  Outside outside;
  const Kick* kick;
  float* const* rows;  ///< by row, from first − 2 (where there is one) to last + 1
  std::size_t first, last;
  bool goes_on;    ///< where the call before ended, whose `carried` it takes over; otherwise rows above count
  float* carried;  ///< P, then the (0,2) pairs' forces of the row above: 6·stride, as a row
  /// Velocity Verlet's velocities half a step behind, by row of the cloth: 3·stride each; null in leapfrog.
  float* half_velocity;
  Bodies bodies;
  LeapAsked leap;
  KicksAsked kicks;
  float* put_off;  ///< room for vectors that contact moves after their row: put_off_floats of them
};
/// Floats that Sweep::put_off has room for: a vector of four columns takes the most.
constexpr std::size_t put_off_floats(std::size_t stride) { return 8 * stride; }

/// XPBD's cloth: the rows as of Sheet, with a wider pad to the right, and beside each how far its particles
/// have moved since the substep began and their inverse masses: mx[stride] my[stride] mz[stride] w[stride].
struct XpbdSheet {
  std::size_t stride, nx, ny;
  float *state, *moved;  ///< 6·stride and 4·stride a row
};
inline constexpr std::size_t kXpbdPad = 64;  ///< columns to the right of the cloth: a step of three vectors

/// Rows [first, last) of the prediction before, or of velocities and contact after the constraints.
struct XpbdMove {
  XpbdSheet sheet;
  Outside outside;
  const Kick* kick;
  std::size_t first, last;
  std::uint32_t has_air, has_contact;
  Bodies bodies;
};

/// Springs or bending triples of one colour that begin in rows [first, last).
struct XpbdPull {
  XpbdSheet sheet;
  std::size_t first, last;
  std::uint32_t colour;
  /// Compliance [m/N] inside and on a boundary line, rest length [m], damping time c/k [s].
  float compliance, compliance_edge, rest, damping_time, step;
};

/// What an XpbdPull pulls, in the order of the solver's items; then the triples along i and along j.
enum XpbdKind { kPullI, kPullJ, kPullDown, kPullUp, kPullTwoI, kPullTwoJ, kBendI, kBendJ, kXpbdKinds };

/// Tethers of rows [first, last): who is farther from its anchor than it may be is pulled back.
struct XpbdTethers {
  XpbdSheet sheet;
  std::size_t first, last;
  const float* reach;    ///< stride a row [m]; below 0 where there is none
  const float* places;   ///< of each anchor where the substep began [m] and how far it has moved: 6
  const float* several;  ///< by particle of such a block, x, y and z: 3·kColumns; null: they are left out
  const std::uint32_t* anchors;  ///< of each kColumns of a row, which of these all of them hang from
  std::size_t blocks;            ///< of a row
  std::uint32_t no_anchor;       ///< added to the number of a block whose particles hang from several
};

/// Vertex normals of rows [first, last) of a cloth of nx × ny, and what is drawn.
struct Surface {
  std::size_t stride, nx, ny, first, last;
  const float* const* rows;             ///< by row
  const float* relative_inverse_mass;   ///< position.w, by particle
  float *position, *velocity, *normal;  ///< vec4 a particle; either of the last two may be null
};

/// The air's kick for rows [first, last) of a cloth of nx × ny.
struct AirKick {
  Sheet sheet;
  std::size_t nx, ny, first, last;
  const float* const* rows;  ///< by row
  const Air* air;
  float gain;     ///< of the kick [s]
  float* kicked;  ///< velocities after it: 3·stride a row of the cloth
};

/// Contact of rows [first, last) with capsules, boxes and the floor after them.
struct SolidTouch {
  Sheet sheet;
  std::size_t nx, first, last;
  float* const* rows;   ///< by row
  const float* before;  ///< positions where the drift began: 3·stride a row
  const Solid* solids;
  std::uint32_t solid_count, has_level, has_tilt;
  float floor_height, floor_friction, tilt_normal[3], tilt_level;
  const Near* near;          ///< which drifts may touch solids; null: any may
  std::uint32_t* left_over;  ///< room for the particles of these rows
};

/// Links of rows [first, last) of a cloth of nx × ny: what is too long breaks.
struct Tear {
  std::size_t stride, nx, ny, first, last;
  const float* const* rows;               ///< by row
  float structural, shear;                ///< the longest length squared [m²]
  int along_i, along_j, falling, rising;  ///< bits of the links, as shared/links.h
  std::uint32_t* broken_links;            ///< by particle
};

/// The longest links of rows [first, last) of a cloth of nx × ny and the fastest particle.
struct LinkLook {
  std::size_t stride, nx, ny, first, last;
  const float* const* rows;  ///< by row
  float structural2, shear2, speed2,
      place2;  ///< results: squares of the largest [m², m²/s²]; from the origin
};

/// Where cells are so even that they are neither folded nor to be looked at for creases: docs/float-form.md
/// "Folds".
struct Smooth {
  float bend2;    ///< least square of what makes two edges that follow each other differ too much [m²]
  float length2;  ///< of an edge, at least [m²]
  float shear;    ///< of the product of two, at most [m²]
  float apart2;   ///< of a corner's way past the others, at least [m²]
};

/// Rows [first, last) of patches of a cloth of nx × ny: boxes and bends, as docs/float-form.md "Patches" and
/// "Folds".
struct PatchLook {
  std::size_t stride, nx, ny, first, last;
  const float* const* rows;        ///< by row of the cloth
  float search_squared, flat_min;  ///< [m², m]
  Smooth smooth;
  float* scratch;            ///< patch_look_floats(nx) of them
  float* boxes;              ///< two vec4 a patch; all but what left_over says of creases
  std::uint32_t* left_over;  ///< room for the cells of these rows: 4·patch + k
  std::uint32_t longest;     ///< result: bits of the longest edge squared
};
/// Floats that PatchLook::scratch has room for.
constexpr std::size_t patch_look_floats(std::size_t nx) {
  const std::size_t columns = (nx + kColumns - 1) / kColumns * kColumns + 2 * kColumns;
  const std::size_t patches = (nx / 2 + kColumns) / kColumns * kColumns + 2 * kColumns;
  return (6 * 3 + 2 + 6 * 3) * columns + (4 * 2 * 3 + 7) * patches;
}

/// Rows [first, last) of a cloth of nx columns: who has moved so far that lists are stale, or out of its
/// room, as docs/float-form.md "Motion".
struct LeashLook {
  std::size_t stride, nx, first, last;
  const float* const* rows;               ///< by row
  const float* relative_inverse_mass;     ///< by particle
  const float *built, *near;              ///< vec4 a particle
  const std::uint32_t* bounds;            ///< by particle: bits of a distance [m]
  std::uint32_t no_bound;                 ///< bits of one without
  float with_lists[3], with_contacts[3];  ///< the motion that all share [m]
  float moved_squared_max, roam_max;      ///< [m², m]
  float surface_limit, roam_share;        ///< [m]
  std::uint32_t* left_over;               ///< room for the particles of these rows
  std::uint32_t stale;                    ///< result
};

/// The same rows where nothing is listed and something is pinned: the largest squares of the way from where
/// lists were made [m²], of speeds [m²/s²] and of the distance from the origin [m²].
struct MotionLook {
  std::size_t stride, nx, first, last;
  const float* const* rows;     ///< by row
  const float* built;           ///< vec4 a particle
  float gone2, speed2, place2;  ///< results
  std::uint32_t unsound;        ///< result: some place or speed is no number
};

/// Rows [first, last) of a cloth of nx × ny, each with the cells below it: whether the cloth is spread out
/// over a plane, nowhere folded (docs/float-form.md "Spread").
struct SpreadLook {
  std::size_t stride, nx, ny, first, last;
  const float* const* rows;     ///< by row of the cloth
  float along[3], down[3];      ///< the plane's axes, of length 1 and at right angles
  float shared_speed[3];        ///< is taken from all velocities [m/s]
  float spread_min, local_min;  ///< what edges go along the plane at least; and cells along their own [m]
  /// Results: largest squares of neighbours' relative speed, of speeds [m²/s²], from the origin and of edges
  /// [m²].
  float apart2, speed2, place2, longest2;
  std::uint32_t unsound;  ///< result: somewhere it is not spread, or some number is none
};

/// Rows [first, last) as vec4s, their last number 0.
struct PlaceRows {
  std::size_t stride, nx, first, last;
  const float* const* rows;  ///< by row
  float* places;             ///< vec4 a particle
};

/// Sixteen boxes of the tree of patches: four by four patches of a leaf, or four by four nodes of the level
/// below, row by row. What is near nothing has its low corner above the high one, both infinite.
struct alignas(64) NearNode {
  float low[3][kColumns], high[3][kColumns];
};
struct NearLevel {
  NearNode* nodes;  ///< row by row
  std::size_t across, down;
};
inline constexpr std::size_t kNearLevels = 8;

/// Rows [first, last) of leaves of cloths of nx × ny patches each: which patches have others near. Every
/// cloth begins with leaves of its own.
struct NearLook {
  std::size_t nx, ny, first, last;
  std::size_t leaf_rows;                                ///< of a cloth
  const float* boxes;                                   ///< two vec4 a patch
  float inverse_cell, cells_most, far_cells, distance;  ///< cells that a search goes beyond a box; [m]
  int cells_across;                                     ///< as many of the grid along an axis are looked at
  std::uint32_t overlooks, looks_far;  ///< whether nothing can be passed over; the bit to set
  NearLevel levels[kNearLevels];
  std::size_t level_count;
  std::uint32_t* listed;  ///< by patch
};

/// Points in blocks of kColumns: all x, all y, all z [m]; those of them that are nearer to a point.
struct NearPoints {
  const float* points;
  std::size_t count;  ///< of whole blocks
  float at[3], squared;
  std::uint32_t* found;  ///< result, room for all: their places, ascending
};

/// Two surfaces nearer than their limit: of the four particles the weights of their motion in the distance,
/// and the way from the second side to the first.
struct SurfaceTouch {
  std::uint32_t particle[4];
  float weight[4], d[3], squared;
  std::uint32_t edges;  ///< whether two edges, or a particle and a triangle
};

/// Listed pairs of one kind. Their particles in blocks of kColumns: all first ones, all second ones, and so
/// on; the rest of the last block names any particle.
struct SurfaceLook {
  const float* near;  ///< vec4 a particle
  const std::uint32_t* corners;
  std::size_t count;
  float limit_squared, edge_tiny;  ///< [m²]
  float* distances;                ///< result, room for whole blocks [m]
  SurfaceTouch* touching;          ///< result, room for all
};

/// Which variant of the sweep: what is absent costs nothing.
enum SweepEffect : std::uint32_t { kDamping = 1, kShear = 2, kTwoApart = 4, kAir = 8, kContact = 16 };
inline constexpr std::uint32_t kSweepVariants = 32;

/// One width's functions.
struct Kernels {
  const char* name;  ///< "AVX-512"
  std::uint32_t lanes;
  void (*sweep[kSweepVariants])(const Sweep&);
  void (*surface)(const Surface&);
  void (*air_kick)(const AirKick&);
  std::size_t (*touch_solids)(const SolidTouch&);  ///< returns how many particles it left over
  std::uint32_t (*tear)(const Tear&);              ///< returns whether anything broke
  void (*look_at_links)(LinkLook&);
  std::size_t (*look_at_motion)(LeashLook&);  ///< returns how many particles are out of their room
  void (*measure_motion)(MotionLook&);
  void (*look_how_spread)(SpreadLook&);
  void (*write_places)(const PlaceRows&);
  std::size_t (*look_at_patches)(PatchLook&);  ///< returns how many cells it left over
  void (*make_near_leaves)(const NearLook&);
  void (*make_near_levels)(const NearLook&);  ///< once all leaves are made
  void (*look_near)(const NearLook&);
  std::size_t (*find_near)(const NearPoints&);           ///< returns how many
  std::size_t (*look_at_triangles)(const SurfaceLook&);  ///< returns how many touch
  std::size_t (*look_at_edges)(const SurfaceLook&);
  void (*xpbd_predict)(const XpbdMove&);
  void (*xpbd_finish)(const XpbdMove&);
  void (*xpbd_tethers)(const XpbdTethers&);
  void (*xpbd_pull[2][kXpbdKinds])(const XpbdPull&);  ///< without damping, and with
  /// `repeats` square roots and divisions of a vector each, as many at a time as hide their latency; returns
  /// their sum so that nobody leaves them out. What the sweep needs of the divider at least.
  float (*divide)(std::uint64_t repeats);
};

/// The kernels; null where this build or this machine has no such instructions.
const Kernels* kernels_plain();
const Kernels* kernels_v2();  ///< x86-64-v2: four lanes
const Kernels* kernels_v3();  ///< AVX2: eight
const Kernels* kernels_v4();  ///< AVX-512: sixteen

}  // namespace weft::native
