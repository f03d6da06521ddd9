// Self-collision's sizes and limits from the model.
#include "passes/collision.h"

#include <bit>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/error.h"
#include "model/distance_grid.h"
#include "model/motion.h"
#include "model/solids.h"

namespace weft {
namespace {

constexpr double kSqueezeMax = 0.85;  // of a pair's flat distance: nearer on the cloth, springs are in charge
constexpr double kThicknessMax = 10.0;  // cells; the table of limits has room for that
constexpr std::uint32_t kIntervalMax = 16;

/// Entries that a list needs where layers lie as densely as they can: discs of the cloth within reach, one
/// layer a thickness; half as much again and 4, because contact is never that even.
std::uint32_t list_capacity(double thickness_cells, double skin_cells, std::uint32_t particles) {
  const double reach = thickness_cells + skin_cells;
  const double layers = std::min(2.0 * reach / thickness_cells, 16.0);
  const double dense = std::numbers::pi * reach * reach * layers * 2.0 / 3.0;
  return static_cast<std::uint32_t>(std::min(std::ceil(1.5 * dense) + 4.0, particles - 1.0));
}

/// First row whose pairs are so far apart on the cloth that they keep the whole thickness.
std::uint32_t last_row(double thickness_cells) {
  const double whole = 0.5 * std::numbers::pi * thickness_cells;
  return static_cast<std::uint32_t>(std::max(1.0, std::ceil(whole * whole)));
}

/// The fastest anything moves that falls, is blown or is hit [m/s]; never less than 1.
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

}  // namespace

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
                model.scene.source.empty() ? "scene" : model.scene.source, thickness_m, model.grid.nx, a,
                kThicknessMax);
  CollisionLayout layout{};
  layout.thickness_m = thickness_m;
  layout.skin_m = std::max(0.25 * thickness_m, 0.5 * a);
  layout.cell_m = 2.02 * (thickness_m + layout.skin_m);  // a hundredth more than reach: rounding of x / cell
  layout.limit_last = last_row(thickness_m / a);
  layout.column_bits = static_cast<std::uint32_t>(std::bit_width(model.grid.nx - 1));
  layout.buckets = std::bit_ceil(model.grid.count());
  layout.capacity = list_capacity(thickness_m / a, layout.skin_m / a, model.grid.count());
  layout.centre = model.grid.index(model.grid.nx / 2, model.grid.ny / 2);
  return layout;
}

std::uint32_t contact_interval(const Model& model, double substep_s) {
  const double time_s = 0.5 * model.scene.self_collision->thickness_m / design_speed_m_s(model);
  return static_cast<std::uint32_t>(std::clamp(std::floor(time_s / substep_s), 1.0, double{kIntervalMax}));
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
  collision.centre = view.layout.centre;
  return collision;
}

template shared::CollisionOf<float> make_collision(const Model&);
template shared::CollisionOf<double> make_collision(const Model&);

Range collision_domain(const Model& model) {
  if (!model.scene.self_collision) return {};
  return whole_cloth(model);
}

}  // namespace weft
