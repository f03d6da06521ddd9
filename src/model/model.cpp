// From a Scene to the Model: grid, masses, pins, spring kinds; and the start state, wind and spheres in time.
#include "model/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "model/distance_grid.h"
#include "model/motion.h"
#include "model/springs.h"
#include "model/step_bound.h"
#include "model/tethers.h"

namespace weft {
namespace {

constexpr std::uint64_t kParticlesMax = std::uint64_t{1} << 26;

/// m0/m of a free particle: 1/(e(i)·e(j)).
std::vector<double> relative_inverse_masses(const Grid& grid) {
  std::vector<double> relative(grid.count());
  for (std::uint32_t j = 0; j < grid.rows(); ++j)
    for (std::uint32_t i = 0; i < grid.nx; ++i)
      relative[grid.index(i, j)] = 1.0 / (line_weight(i, grid.nx) * line_weight(grid.own_row(j), grid.ny));
  return relative;
}

/// Calls visit(particle) for every one within the radius of the pin, on its flat cloth. Returns how many.
template <class Visit>
std::uint64_t for_each_held(const PinSection& pin, const Grid& grid, Visit&& visit) {
  const double x_m = pin.at.x * grid.width_m(), y_m = pin.at.y * grid.height_m();
  const double reach_m = pin.radius_m * (1.0 + 1e-6);
  const auto first = [&](double center_m) {
    return static_cast<std::uint32_t>(std::max(0.0, std::floor((center_m - reach_m) / grid.spacing_m)));
  };
  const auto last = [&](double center_m, std::uint32_t count) {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil((center_m + reach_m) / grid.spacing_m), 0.0, count - 1.0));
  };
  std::uint64_t held = 0;
  for (std::uint32_t j = first(y_m); j <= last(y_m, grid.ny); ++j) {
    for (std::uint32_t i = first(x_m); i <= last(x_m, grid.nx); ++i) {
      const double dx_m = i * grid.spacing_m - x_m, dy_m = j * grid.spacing_m - y_m;
      if (dx_m * dx_m + dy_m * dy_m > reach_m * reach_m) continue;
      visit(grid.index(i, pin.cloth * grid.ny + j));
      ++held;
    }
  }
  return held;
}

void apply_pins(const Scene& scene, const Grid& grid, std::vector<double>& relative) {
  for (std::size_t p = 0; p < scene.pins.size(); ++p) {
    const PinSection& pin = scene.pins[p];
    if (pin.cloth >= grid.cloths)
      throw error(Exit::usage,
                  "{}: pins[{}] holds cloth {}; it must be 0 to {} (add the cloth, or remove the pin)",
                  place_of(scene, fmt::format("pins.{}.cloth", p)), p, pin.cloth, grid.cloths - 1);
    if (for_each_held(pin, grid, [&](std::uint32_t particle) { relative[particle] = 0.0; }) == 0)
      throw error(Exit::usage,
                  "{}: pins[{}] at ({}, {}) with radius {} m holds no particle; a radius of {} m always does",
                  place_of(scene, fmt::format("pins.{}.radius", p)), p, pin.at.x, pin.at.y, pin.radius_m,
                  grid.spacing_m * 0.5 * std::sqrt(2.0));
  }
}

/// Puts the particles of one cloth, whose rows begin at `first`.
void lay_flat(const Grid& grid, const ClothSection& cloth, std::uint32_t first, State& state) {
  const bool vertical = cloth.orientation == Orientation::vertical;
  constexpr double kPi = std::numbers::pi;
  for (std::uint32_t j = 0; j < grid.ny; ++j) {
    const double s = j * grid.spacing_m, wave_j = std::sin(2.0 * kPi * j / (grid.ny - 1) + 0.9);
    for (std::uint32_t i = 0; i < grid.nx; ++i) {
      const double u = i * grid.spacing_m - 0.5 * cloth.width_m;
      const double lift = cloth.imperfection_m * std::sin(3.0 * kPi * i / (grid.nx - 1) + 0.4) * wave_j;
      const glm::dvec3 offset = vertical ? glm::dvec3(u, 0.5 * grid.height_m() - s, lift)
                                         : glm::dvec3(u, lift, s - 0.5 * grid.height_m());
      state.position[grid.index(i, first + j)] = cloth.center_m + offset;
    }
  }
}

State flat_state(const Model& model) {
  const Grid& grid = model.grid;
  State state;
  state.position.resize(grid.count());
  state.velocity.assign(grid.count(), glm::dvec3(0.0));
  for (std::uint32_t cloth = 0; cloth < grid.cloths; ++cloth)
    lay_flat(grid, cloth_of(model.scene, cloth), cloth * grid.ny, state);
  return state;
}

/// When a pin lets go [s]; infinite when it never does.
double held_until_s(const PinSection& pin) {
  return pin.release_s.value_or(std::numeric_limits<double>::infinity());
}

/// For every held particle the pin that holds it longest, of equal ones the first; kNoPin for free ones.
constexpr std::uint32_t kNoPin = ~0u;
std::vector<std::uint32_t> owners(const Scene& scene, const Grid& grid) {
  std::vector<std::uint32_t> owner(grid.count(), kNoPin);
  for (std::uint32_t k = 0; k < scene.pins.size(); ++k)
    for_each_held(scene.pins[k], grid, [&](std::uint32_t p) {
      if (owner[p] == kNoPin || held_until_s(scene.pins[k]) > held_until_s(scene.pins[owner[p]]))
        owner[p] = k;
    });
  return owner;
}

/// Which particles are held by pins that move or let go. Nothing, and no work, where there are none.
void find_moved_particles(Model& model) {
  const std::vector<PinSection>& pins = model.scene.pins;
  std::vector<std::uint32_t> moved(pins.size(), kNoPin);  // the how-manieth of those
  for (std::uint32_t k = 0; k < pins.size(); ++k) {
    if (!pins[k].moves() && !pins[k].release_s) continue;
    moved[k] = static_cast<std::uint32_t>(model.moved_pins.size());
    model.moved_pins.push_back(k);
  }
  if (model.moved_pins.empty()) return;
  const std::vector<std::uint32_t> owner = owners(model.scene, model.grid);
  const State start = flat_state(model);
  const std::vector<double> free = relative_inverse_masses(model.grid);
  std::vector<double> released = model.relative_inverse_mass;
  for (std::uint32_t p = 0; p < owner.size(); ++p) {
    if (owner[p] == kNoPin || moved[owner[p]] == kNoPin) continue;
    model.moved_particles.push_back({p, moved[owner[p]], start.position[p]});
    if (pins[owner[p]].release_s) released[p] = free[p];
  }
  if (released != model.relative_inverse_mass) model.released_inverse_mass = std::move(released);
}

std::array<SpringKind, kSpringKindCount> build_springs(const MaterialSection& m, double a, double mass_kg) {
  const auto structural = [&](double membrane_n_m) { return (1.0 - m.flex) * 0.75 * membrane_n_m; };
  const auto flex = [&](double membrane_n_m) { return m.flex * 3.0 * membrane_n_m / 16.0; };
  const double weft_n_m = m.membrane_weft(), warp_n_m = m.membrane_warp();
  const auto kind = [&](int di, int dj, double k, double rest_m, bool halves) {
    const double cap = 2.0 * m.damping_ratio_max * std::sqrt(k * mass_kg / 2.0);
    return SpringKind{di, dj, k, rest_m, std::min(m.damping_s * k, cap), halves};
  };
  const double diagonal_m = a * std::numbers::sqrt2;
  return {kind(1, 0, structural(weft_n_m), a, true), kind(0, 1, structural(warp_n_m), a, true),
          kind(1, 1, m.shear(), diagonal_m, false),  kind(-1, 1, m.shear(), diagonal_m, false),
          kind(2, 0, flex(weft_n_m), 2.0 * a, true), kind(0, 2, flex(warp_n_m), 2.0 * a, true)};
}

}  // namespace

Grid build_grid(const Scene& scene) {
  const ClothSection& cloth = scene.cloth;
  if (cloth.resolution < 2)
    throw error(Exit::usage, "{}: cloth.resolution is {}; it must be at least 2",
                place_of(scene, "cloth.resolution"), cloth.resolution);
  const double spacing_m = cloth.width_m / (cloth.resolution - 1);
  const double cells = std::round(cloth.height_m / spacing_m);  // halves away from zero
  if (!(cells >= 1.0))
    throw error(Exit::usage,
                "{}: cloth.height is {} m, less than half a cell of {} m; raise it or cloth.resolution",
                place_of(scene, "cloth.height"), cloth.height_m, spacing_m);
  const std::uint32_t cloths = cloth_count(scene);
  if ((cells + 1.0) * cloth.resolution * cloths > static_cast<double>(kParticlesMax))
    throw error(
        Exit::usage,
        "{}: cloth.resolution is {}, which makes {} x {} particles{}; at most {} are possible (lower it)",
        place_of(scene, "cloth.resolution"), cloth.resolution, cloth.resolution, cells + 1.0,
        cloths > 1 ? fmt::format(" in each of {} cloths", cloths) : "", kParticlesMax);
  return {cloth.resolution, static_cast<std::uint32_t>(cells) + 1, spacing_m, cloths};
}

namespace {

void load_meshes(Model& model) {
  const Scene& scene = model.scene;
  std::size_t samples = 0;
  for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
    model.meshes.push_back(load_distance_grid(scene, k, model.half_thickness_m));
    samples += model.meshes.back()->distance.size();
    if (samples > kMeshSamplesMax)
      throw error(Exit::usage,
                  "{}: the distance grids of meshes.0 to meshes.{} have {} samples; at most {} are possible "
                  "(lower meshes.resolution)",
                  place_of(scene, fmt::format("meshes.{}.resolution", k)), k, samples, kMeshSamplesMax);
  }
}

}  // namespace

Model build_model(const Scene& scene) {
  Model model;
  model.scene = scene;
  model.grid = build_grid(scene);
  const double a = model.grid.spacing_m;
  model.interior_mass_kg = scene.material.density_kg_m2 * a * a;
  model.relative_inverse_mass = relative_inverse_masses(model.grid);
  apply_pins(scene, model.grid, model.relative_inverse_mass);
  find_moved_particles(model);
  model.springs = build_springs(scene.material, a, model.interior_mass_kg);
  model.bend_kappa_n_m = {scene.material.bend_weft() / (a * a), scene.material.bend_warp() / (a * a)};
  model.half_thickness_m = scene.self_collision ? 0.5 * scene.self_collision->thickness_m : 0.0;
  load_meshes(model);
  for_each_spring(model,
                  [&](const SpringKind&, std::uint32_t, std::uint32_t, double) { ++model.spring_count; });
  model.bound = step_bound(model);
  if (scene.tethers) model.tethers = find_tethers(model, scene.tethers->slack);
  return model;
}

Model with_mass_scale(const Model& model, std::span<const double> inverse_mass_scale) {
  WEFT_ASSERT(inverse_mass_scale.size() == model.relative_inverse_mass.size());
  Model scaled = model;
  for (std::size_t p = 0; p < inverse_mass_scale.size(); ++p)
    scaled.relative_inverse_mass[p] *= inverse_mass_scale[p];
  for (std::size_t p = 0; p < scaled.released_inverse_mass.size(); ++p)
    scaled.released_inverse_mass[p] *= inverse_mass_scale[p];
  scaled.bound = step_bound(scaled);
  return scaled;
}

State start_state(const Model& model) {
  State state = flat_state(model);
  place_moved_pins(model, state);
  return state;
}

double Model::inverse_mass_at(std::uint32_t particle, double time_s) const {
  if (released_inverse_mass.empty() || relative_inverse_mass[particle] == released_inverse_mass[particle])
    return relative_inverse_mass[particle];
  const auto held = std::ranges::lower_bound(moved_particles, particle, {}, &MovedParticle::particle);
  const bool released = has_released(scene.pins[moved_pins[held->pin]], time_s);
  return released ? released_inverse_mass[particle] : 0.0;
}

bool has_released(const PinSection& pin, double time_s) {
  constexpr double kRoundOff_s = 1e-9;  // of a sum of substeps that should end at the release
  return time_s > held_until_s(pin) - kRoundOff_s;
}

glm::dvec3 pin_offset_at(const Scene& scene, const PinSection& pin, double time_s) {
  if (!pin.keys.empty()) return place_at(pin.keys, time_s);
  const auto sphere = attached_sphere(scene, pin);
  if (!sphere) return glm::dvec3(0.0);
  return sphere_center_at(scene.spheres[*sphere], time_s) - sphere_center_at(scene.spheres[*sphere], 0.0);
}

glm::dvec3 pin_velocity_before(const Scene& scene, const PinSection& pin, double time_s) {
  if (!pin.keys.empty()) return velocity_before(pin.keys, time_s);
  const auto index = attached_sphere(scene, pin);
  if (!index) return glm::dvec3(0.0);
  const SphereSection& sphere = scene.spheres[*index];
  return sphere.keys.empty() ? sphere.velocity_m_s : velocity_before(sphere.keys, time_s);
}

void place_moved_pins(const Model& model, State& state) {
  for (const MovedParticle& held : model.moved_particles) {
    const PinSection& pin = model.scene.pins[model.moved_pins[held.pin]];
    if (has_released(pin, state.time_s)) continue;
    state.position[held.particle] = held.anchor_m + pin_offset_at(model.scene, pin, state.time_s);
    state.velocity[held.particle] = pin_velocity_before(model.scene, pin, state.time_s);
  }
}

glm::dvec3 wind_at(const Scene& scene, double time_s) {
  if (!scene.wind) return glm::dvec3(0.0);
  const WindSection& wind = *scene.wind;
  if (!(wind.period_s > 0.0)) return wind.velocity_m_s;
  return wind.velocity_m_s * (1.0 + wind.gust * std::sin(2.0 * std::numbers::pi * time_s / wind.period_s));
}

glm::dvec3 sphere_center_at(const SphereSection& sphere, double time_s) {
  if (!sphere.keys.empty()) return place_at(sphere.keys, time_s);
  return sphere.center_m + time_s * sphere.velocity_m_s;
}

}  // namespace weft
