// Self-collision's sizes and limits from the model.
#include "passes/collision.h"

#include <bit>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/error.h"
#include "model/distance_grid.h"
#include "model/motion.h"
#include "model/solids.h"
#include "passes/patches.h"

namespace weft {
namespace {

constexpr double kSqueezeMax = 0.85;  // of a pair's flat distance: nearer on the cloth, springs are in charge
constexpr double kThicknessMax = 10.0;  // cells; the table of limits has room for that
constexpr std::uint32_t kIntervalMax = 16;
constexpr double kSurfaceLimit = 0.25;  // cells: what surfaces keep of a thickness that is more
constexpr double kSurfaceReach =
    0.55;  // cells; less than the 0.707 from a particle to a triangle of a flat cloth
constexpr double kRecoverShare = 0.25;    // of what contacts overlap, what they part by until the next look
constexpr double kStaleShare = 0.5;       // of the skin: two that far nearer each other may not touch yet
constexpr double kStaleRoamShare = 0.55;  // of roam_max at most: the rest is for motion until the next look
constexpr double kPileLayers = 20;  // that contacts hold, pressed to three quarters of the distance they keep
constexpr std::uint32_t kPlaceBits = 26;
constexpr double kPatchEdge = 1.1;  // of its length on the cloth: an edge that is no longer than expected

/// Entries that a list needs where layers lie as densely as they can: discs of the cloth within reach, one
/// layer a thickness; half as much again and 4, because contact is never that even.
std::uint32_t list_capacity(double thickness_cells, double skin_cells, std::uint32_t particles) {
  const double reach = thickness_cells + skin_cells;
  const double layers = std::min(2.0 * reach / thickness_cells, 16.0);
  const double dense = std::numbers::pi * reach * reach * layers * 2.0 / 3.0;
  return static_cast<std::uint32_t>(std::min(std::ceil(1.5 * dense) + 4.0, particles - 1.0));
}

/// Entries that a list of triangles and edges needs: some 20 of each layer within reach. Layers that are
/// crushed lie far denser than their thickness lets them, so that small cloths have room for fifty; all
/// lists together stay within what every device binds at once where 96 each allow that.
std::uint32_t surface_capacity(std::uint32_t particles) {
  constexpr std::uint32_t kEntriesBound = 1u << 25;  // of 4 bytes: 128 MiB
  return std::clamp(kEntriesBound / particles, 96u, 1024u);
}

/// How far apart the nearest corners of two surfaces within reach can be, where no edge is longer than
/// kPatchEdge times a flat cell's diagonal.
double surface_search_m(const CollisionLayout& layout, double spacing_m) {
  return std::hypot(layout.surface_reach_m, kPatchEdge * spacing_m);
}

/// Edge of the grid's cubes: so much of what is looked for that a box and what is round it lie in few of
/// them, and that few blocks are in one. Measured: docs/effects.md.
double grid_cell_m(const CollisionLayout& layout, double spacing_m) {
  return 7.0 * std::max(layout.thickness_m + layout.skin_m, surface_search_m(layout, spacing_m));
}

/// First row whose pairs are so far apart on the cloth that they keep the whole thickness.
std::uint32_t last_row(double thickness_cells) {
  const double whole = 0.5 * std::numbers::pi * thickness_cells;
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(whole * whole)));
}

/// The longest time [s] between two looks at contacts with which those of a pile hold it. Each takes a
/// quarter of what it would take alone, for it has neighbours above and below: with that the speed at which
/// they part, a quarter of recover · deep, is the weight's gain in that time.
double pile_time_s(const Model& model, const CollisionLayout& layout) {
  if (!model.scene.gravity) return 1.0;
  const double weight_m_s2 = kPileLayers * glm::length(model.scene.gravity->acceleration_m_s2);
  return std::sqrt(kRecoverShare * layout.deep_m / (4.0 * std::max(weight_m_s2, 1e-3)));
}

}  // namespace

double design_speed_m_s(const Model& model) {
  const Scene& scene = model.scene;
  double drop_m = std::hypot(model.grid.width_m(), model.grid.height_m());
  const double size_m = drop_m;
  for (std::size_t k = 0; k < cloth_count(scene); ++k) {
    const glm::dvec3 center_m = cloth_of(scene, k).center_m;
    if (scene.floor) drop_m = std::max(drop_m, center_m.y + size_m / 2 - scene.floor->height_m);
    drop_m = std::max(drop_m, glm::distance(center_m, scene.cloth.center_m) + size_m);  // onto another cloth
  }
  double speed_m_s = 1.0;
  if (scene.gravity) speed_m_s += std::sqrt(2.0 * glm::length(scene.gravity->acceleration_m_s2) * drop_m);
  if (scene.wind) speed_m_s += glm::length(scene.wind->velocity_m_s) * (1.0 + scene.wind->gust);
  for (const SphereSection& sphere : scene.spheres) {
    const double own_m_s = sphere.keys.empty() ? glm::length(sphere.velocity_m_s) : fastest_m_s(sphere.keys);
    speed_m_s = std::max(speed_m_s, 1.0 + 2.0 * own_m_s);
  }
  for (const Solid& solid : solids_of(scene))
    speed_m_s = std::max(speed_m_s, 1.0 + 2.0 * fastest_m_s(*solid.section, extent_m(solid)));
  for (const MeshSection& mesh : scene.meshes)
    speed_m_s = std::max(speed_m_s, 1.0 + 2.0 * fastest_m_s(mesh, kMeshFarthest_m));
  for (const std::uint32_t pin : model.moved_pins)
    speed_m_s = std::max(speed_m_s, 1.0 + 2.0 * fastest_m_s(scene.pins[pin].keys));
  return speed_m_s;
}

bool shares_motion(const Model& model) {
  return std::ranges::none_of(model.relative_inverse_mass, [](double w) { return w == 0.0; });
}

double pair_limit_m(double thickness_m, double flat_m) {
  const double turn = std::min(flat_m / thickness_m, 0.5 * std::numbers::pi);
  return std::min(thickness_m * std::sin(turn), kSqueezeMax * flat_m);
}

CollisionLayout collision_layout(const Model& model) {
  const double thickness_m = model.scene.self_collision->thickness_m, a = model.grid.spacing_m;
  if (thickness_m > kThicknessMax * a)
    throw error(Exit::usage,
                "{}: self_collision.thickness is {} m; at cloth.resolution {} the particles are {:.4g} m "
                "apart, and the thickness may be at most {} times that (lower one of the two)",
                place_of(model.scene, "self_collision.thickness"), thickness_m, model.grid.nx, a,
                kThicknessMax);
  CollisionLayout layout{};
  layout.thickness_m = thickness_m;
  layout.surface_limit_m = std::min(thickness_m, kSurfaceLimit * a);
  layout.surface_reach_m = kSurfaceReach * a;
  layout.deep_m = 0.5 * layout.surface_limit_m;
  layout.skin_m = layout.surface_reach_m - layout.surface_limit_m;
  layout.roam_max_m = 0.499 * layout.surface_reach_m;
  layout.stale_m = std::min(kStaleShare * layout.skin_m, kStaleRoamShare * layout.roam_max_m);
  layout.cell_m = grid_cell_m(layout, a);
  layout.limit_last = last_row(thickness_m / a);
  layout.surface_capacity = surface_capacity(model.grid.count());
  layout.column_bits = static_cast<std::uint32_t>(std::bit_width(model.grid.nx - 1));
  if (layout.column_bits + static_cast<std::uint32_t>(std::bit_width(model.grid.rows() - 1)) > kPlaceBits)
    throw error(Exit::usage,
                "{}: [self_collision] with {} x {} particles: it takes at most 8192 x 8192 (lower "
                "cloth.resolution)",
                place_of(model.scene, "cloth.resolution"), model.grid.nx, model.grid.rows());
  layout.buckets = std::bit_ceil(PatchGrid(model.grid).block_count());
  layout.recover_1_s = kRecoverShare / look_time_s(model, layout);
  layout.capacity = list_capacity(thickness_m / a, layout.skin_m / a, model.grid.count());
  layout.pair_reach_m = kRoundingRoom * (layout.thickness_m + layout.skin_m);
  layout.patch_search_m = kRoundingRoom * std::max(surface_search_m(layout, a), layout.pair_reach_m);
  return layout;
}

double look_time_s(const Model& model, const CollisionLayout& layout) {
  const double room_m = std::min(layout.roam_max_m - layout.stale_m, 0.4 * layout.surface_limit_m);
  return std::min(room_m / design_speed_m_s(model), pile_time_s(model, layout));
}

std::uint32_t contact_interval(const Model& model, double substep_s) {
  const CollisionLayout layout = collision_layout(model);
  const double time_s = look_time_s(model, layout);
  const double substeps = std::clamp(std::floor(time_s / substep_s), 1.0, double{kIntervalMax});
  return std::bit_floor(static_cast<std::uint32_t>(substeps));
}

std::uint32_t list_interval(const Model& model, double substep_s) {
  const CollisionLayout layout = collision_layout(model);
  const double time_s = (layout.roam_max_m - layout.stale_m) / design_speed_m_s(model);
  const double looks = std::floor(time_s / (substep_s * contact_interval(model, substep_s)));
  const auto times = static_cast<std::uint32_t>(std::clamp(looks, 1.0, double{kIntervalMax}));
  return std::bit_floor(times) * contact_interval(model, substep_s);
}

std::uint32_t contact_substeps(const Model& model) {
  if (!model.scene.self_collision) return 1;
  const CollisionLayout layout = collision_layout(model);
  const double half_m = 0.5 * layout.surface_limit_m;
  const double step_s = std::min(half_m / design_speed_m_s(model), pile_time_s(model, layout));
  const double substeps = std::ceil(model.scene.solver.frame_s / step_s);
  return static_cast<std::uint32_t>(std::clamp(substeps, 1.0, 0x1p24));
}

std::vector<PairLimit<double>> pair_limits(const Model& model, const CollisionLayout& layout) {
  std::vector<PairLimit<double>> limits;
  for (std::uint32_t m = 0; m <= layout.limit_last; ++m) {
    const double flat_m = model.grid.spacing_m * std::sqrt(static_cast<double>(m));
    const double limit_m =
        m == layout.limit_last ? layout.thickness_m : pair_limit_m(layout.thickness_m, flat_m);
    limits.push_back({limit_m, limit_m * limit_m, std::pow(limit_m + layout.skin_m, 2)});
  }
  return limits;
}

template <class T>
shared::CollisionOf<T> make_collision(const Model& model) {
  const CollisionView<T> view(model);
  shared::CollisionOf<T> collision{};
  for (std::size_t m = 0; m < view.limits.size(); ++m)
    collision.limits[m] = {view.limits[m].limit, view.limits[m].squared, view.limits[m].reach_squared, T(0)};
  collision.inverse_cell_1_m = view.inverse_cell;
  collision.moved_squared_max_m2 = view.moved_squared_max;
  collision.limit_last = view.layout.limit_last;
  collision.column_bits = view.layout.column_bits;
  collision.bucket_mask = view.layout.buckets - 1;
  collision.capacity = view.layout.capacity;
  const bool in_the_way = model.scene.floor.has_value() || !model.scene.spheres.empty();
  collision.carried = shares_motion(model) ? (in_the_way ? 1 : 2) : 0;
  collision.surface_capacity = view.layout.surface_capacity;
  collision.surface_limit_m = view.surface_limit;
  collision.surface_limit_squared_m2 = view.surface_limit_squared;
  collision.surface_reach_squared_m2 = view.surface_reach_squared;
  collision.roam_max_m = view.roam_max;
  collision.flat_min_m = view.flat_min;
  collision.deep_m = view.deep;
  collision.recover_1_s = view.recover;
  collision.friction = view.friction;
  collision.pair_reach_m = view.pair_reach;
  collision.patch_search_m = view.patch_search;
  collision.patch_search_squared_m2 = view.patch_search_squared;
  return collision;
}

template shared::CollisionOf<float> make_collision(const Model&);
template shared::CollisionOf<double> make_collision(const Model&);

Range collision_domain(const Model& model) {
  if (!model.scene.self_collision) return {};
  return whole_cloth(model);
}

Range block_domain(const Model& model) {
  if (!model.scene.self_collision) return {};
  const PatchGrid patches(model.grid);
  return {.x = patches.blocks_x(), .y = patches.block_count() / patches.blocks_x()};
}

Range patch_domain(const Model& model) {
  if (!model.scene.self_collision) return {};
  const PatchGrid patches(model.grid);
  return {.x = patches.nx(), .y = patches.rows()};
}

}  // namespace weft
