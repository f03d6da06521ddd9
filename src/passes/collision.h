// Self-collision as numbers: the limits of pairs, the grid's cells and the room of the lists, from the model;
// and what the mirrors of its passes share. Operation by operation as docs/float-form.md "Self-collision".
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "passes/host_buffers.h"
#include "passes/pass.h"

namespace weft {

/// Sizes that follow from the model; only for scenes with [self_collision].
struct CollisionLayout {
  double thickness_m;
  double skin_m;              ///< how much nearer than listed a pair may come before the lists are made anew
  double cell_m;              ///< edge of the cubes of the grid that blocks are sorted into
  std::uint32_t limit_last;   ///< row of the limits of pairs that are far apart on the cloth
  std::uint32_t column_bits;  ///< of a place, for the column
  std::uint32_t buckets;      ///< a power of two, at least the number of blocks
  std::uint32_t capacity;     ///< entries a particle's list has room for
  double surface_limit_m;     ///< the distance that triangles and edges keep
  double surface_reach_m;     ///< nearer when the lists are made, and they are listed
  double stale_m;             ///< a particle that has moved so far makes the lists stale
  double roam_max_m;          ///< and this far none may be from where they were made
  double deep_m;              ///< of what contacts overlap, what counts
  double recover_1_s;         ///< they part with that much speed a metre of it
  std::uint32_t surface_capacity;  ///< entries a particle's list of triangles and edges has room for
  double pair_reach_m;             ///< nearer when the lists are made, and any pair may be listed
  double patch_search_m;  ///< as far as particles are searched where no edge is longer than kPatchEdge times
                          ///< a cell's
};

/// @throws Error(Exit::usage) when the thickness is more than 10 cells of the cloth, or its particles' places
///         do not fit a list's entry.
CollisionLayout collision_layout(const Model& model);

/// Whether the motion that all share is taken from everyone's: nothing is pinned.
bool shares_motion(const Model& model);

/// The distance [m] that a pair keeps whose distance on the flat cloth is `flat_m`: the thickness, or less
/// where the pair is so near on the cloth that a fold of that thickness brings it nearer (docs/physics.md).
double pair_limit_m(double thickness_m, double flat_m);

/// The fastest that anything can be expected to move against anything [m/s]: what falls, is blown or is hit.
double design_speed_m_s(const Model& model);

/// The longest time [s] between two looks at motion and contacts: at the design speed no particle leaves the
/// room that the lists promise, and the contacts of a pile of kPileLayers hold it.
double look_time_s(const Model& model, const CollisionLayout& layout);

/// Every how many substeps of that length motion is looked at: as look_time_s allows; a power of two, at
/// most 16.
std::uint32_t contact_interval(const Model& model, double substep_s);

/// Every how many substeps of that length the lists can be made anew: contact_interval or some times as many,
/// as many as no particle that moves at the design speed leaves the lists' room in.
std::uint32_t list_interval(const Model& model, double substep_s);

/// The fewest substeps of a frame with which, at the design speed, a particle moves by at most half the
/// surfaces' limit in one; 1 without [self_collision].
std::uint32_t contact_substeps(const Model& model);

/// The block that the device reads, computed in double and rounded once to T.
template <class T = float>
shared::CollisionOf<T> make_collision(const Model& model);

/// Whole cloth, or nothing when the scene has no [self_collision].
Range collision_domain(const Model& model);

/// A pass over all particles that takes its workgroups from a word of collision_state: none where there is
/// nothing to do.
constexpr Pass collision_pass(std::string_view name, std::string_view about,
                              decltype(Pass::mirror_f32) mirror_f32, decltype(Pass::mirror_f64) mirror_f64,
                              std::uint32_t groups_word) {
  return {.name = name,
          .about = about,
          .domain = collision_domain,
          .mirror_f32 = mirror_f32,
          .mirror_f64 = mirror_f64,
          .interval = contact_interval,
          .groups_word = groups_word};
}

/// One of those that make the lists.
/// @param domain        what a dispatch of it covers
/// @param settle_order  as Pass::settle_order
constexpr Pass list_pass(std::string_view name, std::string_view about, decltype(Pass::mirror_f32) mirror_f32,
                         decltype(Pass::mirror_f64) mirror_f64, std::uint32_t groups_word,
                         decltype(Pass::domain) domain = collision_domain,
                         decltype(Pass::settle_order) settle_order = nullptr) {
  Pass pass = collision_pass(name, about, mirror_f32, mirror_f64, groups_word);
  pass.domain = domain;
  pass.interval = list_interval;
  pass.settle_order = settle_order;
  pass.takes_texels = groups_word != shared::kScanGroups;  // all others read positions or boxes
  return pass;
}

/// What bounds on distances are multiplied by, so that rounding of what they are compared with is nothing.
inline constexpr double kRoundingRoom = 1.001;

/// A pair's limit as the passes read it.
template <class T>
struct PairLimit {
  T limit, squared, reach_squared;
};

/// Entry m: pairs di² + dj² = m cells² apart on the cloth; the last: all others. In double, to be rounded
/// once.
std::vector<PairLimit<double>> pair_limits(const Model& model, const CollisionLayout& layout);

/// What the mirrors read, in T.
template <class T>
struct CollisionView {
  const Grid& grid;
  CollisionLayout layout;
  std::vector<PairLimit<T>> limits;
  T inverse_cell, moved_squared_max;
  T surface_limit, surface_limit_squared, surface_reach_squared, roam_max, flat_min, deep, recover, friction;
  T pair_reach, patch_search, patch_search_squared;

  explicit CollisionView(const Model& model)
      : grid(model.grid), layout(collision_layout(model)), limits(layout.limit_last + 1) {
    const auto exact = pair_limits(model, layout);
    std::ranges::transform(exact, limits.begin(), [](const PairLimit<double>& p) {
      return PairLimit<T>{static_cast<T>(p.limit), static_cast<T>(p.squared),
                          static_cast<T>(p.reach_squared)};
    });
    inverse_cell = static_cast<T>(1.0 / layout.cell_m);
    moved_squared_max = static_cast<T>(layout.stale_m * layout.stale_m);
    surface_limit = static_cast<T>(layout.surface_limit_m);
    surface_limit_squared = static_cast<T>(layout.surface_limit_m * layout.surface_limit_m);
    surface_reach_squared = static_cast<T>(layout.surface_reach_m * layout.surface_reach_m);
    roam_max = static_cast<T>(layout.roam_max_m);
    flat_min = static_cast<T>(layout.surface_reach_m * kRoundingRoom);
    deep = static_cast<T>(layout.deep_m);
    recover = static_cast<T>(layout.recover_1_s);
    friction = static_cast<T>(model.scene.self_collision->friction);
    pair_reach = static_cast<T>(layout.pair_reach_m);
    patch_search = static_cast<T>(layout.patch_search_m);
    patch_search_squared = static_cast<T>(layout.patch_search_m * layout.patch_search_m);
  }

  std::uint32_t place_of(std::uint32_t particle) const {
    return (particle / grid.nx) << layout.column_bits | particle % grid.nx;
  }
  std::uint32_t particle_at(std::uint32_t place) const {
    const std::uint32_t columns = (1u << layout.column_bits) - 1;
    return (place >> layout.column_bits) * grid.nx + (place & columns);
  }

  using Cell = std::array<std::int32_t, 3>;
  bool covered(const glm::vec<4, T>& x) const {
    const T most = static_cast<T>(shared::kCellsFromOriginMax);
    return std::abs(x.x * inverse_cell) < most && std::abs(x.y * inverse_cell) < most &&
           std::abs(x.z * inverse_cell) < most;
  }
  Cell cell_of(const glm::vec<4, T>& x) const {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(std::floor(x[axis] * inverse_cell));
    return cell;
  }

  std::uint32_t bucket_of(const Cell& cell) const {
    constexpr std::array<std::uint32_t, 3> kPrimes{73856093u, 19349663u, 83492791u};
    std::uint32_t hash = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      hash ^= static_cast<std::uint32_t>(cell[axis]) * kPrimes[axis];
    return hash & (layout.buckets - 1);
  }

  const PairLimit<T>& limit(std::uint32_t a, std::uint32_t b) const {
    if (a / (grid.nx * grid.ny) != b / (grid.nx * grid.ny)) return limits[layout.limit_last];  // two cloths
    const auto apart = [](std::uint32_t p, std::uint32_t q) { return std::uint64_t{p > q ? p - q : q - p}; };
    const std::uint64_t di = apart(a % grid.nx, b % grid.nx), dj = apart(a / grid.nx, b / grid.nx);
    return limits[std::min(di * di + dj * dj, std::uint64_t{layout.limit_last})];
  }
};

template <class T>
T squared_distance(const glm::vec<4, T>& a, const glm::vec<4, T>& b) {
  const T x = b.x - a.x, y = b.y - a.y, z = b.z - a.z;
  return (x * x + y * y) + z * z;
}

/// What a contact adds to touch_weight of a particle that moves by `weight` of it; never nothing.
template <class T>
std::uint32_t touch_units(T weight) {
  return static_cast<std::uint32_t>(weight * static_cast<T>(shared::kTouchQuantum_1)) + 1;
}

/// The weights of a particle's contacts, added up.
template <class T>
T touching_in(const std::vector<std::uint32_t>& weights, std::uint32_t particle) {
  return static_cast<T>(weights[particle]) * (T(1) / static_cast<T>(shared::kTouchQuantum_1));
}

/// The speed at which contacts that overlap by `depth` are to part.
template <class T>
T parting_speed(const CollisionView<T>& view, T depth) {
  return std::min(std::max(depth, T(0)), view.deep) * view.recover;
}

/// Whether patches are to be looked at: the lists are stale.
inline bool lists_stale(const HostWords& buffers) {
  return buffers.words_of(BufferId::collision_state)[shared::kListGroups] != 0;
}

/// Whether lists are being made anew: what the passes from cell_count to surface_gather ask first.
inline bool lists_in_making(const HostWords& buffers) {
  return buffers.words_of(BufferId::collision_state)[shared::kNearGroups] != 0;
}

/// Says that some list has an entry: contacts are to be looked at.
inline void mark_listed(const Grid& grid, HostWords& buffers) {
  auto& state = buffers.words_of(BufferId::collision_state);
  state[shared::kPairsListed] = 1;
  state[shared::kContactGroups] = (grid.nx + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
}

/// Says that something touches: contacts are to be computed.
inline void mark_touching(const Grid& grid, HostWords& buffers) {
  buffers.words_of(BufferId::collision_state)[shared::kTouchGroups] =
      (grid.nx + shared::kCollisionGroup - 1) / shared::kCollisionGroup;
}

/// Whether something touches: what surface_contact and self_contact ask first.
inline bool touching_somewhere(const HostWords& buffers) {
  return buffers.words_of(BufferId::collision_state)[shared::kTouchGroups] != 0;
}

/// Whether what is listed is to be looked at: what touch_weight and surface_touch ask first.
inline bool contacts_due(const HostWords& buffers) {
  return buffers.words_of(BufferId::collision_state)[shared::kContactGroups] != 0;
}

}  // namespace weft
