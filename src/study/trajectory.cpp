// Trajectories on the CPU reference, and distances between them.
#include "study/trajectory.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"
#include "model/measures.h"
#include "sim/simulation.h"

namespace weft::study {
namespace {

constexpr double kNotFinite_m = std::numeric_limits<double>::infinity();

/// A place along one axis of a grid: between two lines, and how far towards the second.
struct Place {
  std::uint32_t first = 0, second = 0;
  double share = 0.0;
};

Place place_on(double at_m, double spacing_m, std::uint32_t count) {
  constexpr double kSame = 1e-9;  // of a cell: a shared particle is read directly
  const double cell = std::clamp(at_m / spacing_m, 0.0, static_cast<double>(count - 1));
  const double below = std::floor(cell + kSame);
  const auto first = static_cast<std::uint32_t>(below);
  const double share = std::max(0.0, cell - below);
  if (share <= kSame || first + 1 >= count) return {first, first, 0.0};
  return {first, first + 1, share};
}

glm::dvec3 position_at(const Grid& grid, const State& state, std::uint32_t cloth, const Place& u,
                       const Place& v) {
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return state.position[grid.index(i, cloth * grid.ny + j)];
  };
  const glm::dvec3 above = glm::mix(at(u.first, v.first), at(u.second, v.first), u.share);
  const glm::dvec3 below = glm::mix(at(u.first, v.second), at(u.second, v.second), u.share);
  return glm::mix(above, below, v.share);
}

}  // namespace

Model with_setting(const Model& model, const Setting& setting) {
  Model changed = model;
  changed.scene.solver.name = setting.solver;
  changed.scene.solver.precision = setting.precision;
  changed.scene.solver.substeps = setting.substeps;
  return changed;
}

Trajectory run_on_cpu(const Model& model, const Setting& setting, double time_s, const Stop& stop,
                      const std::optional<State>& start) {
  const Model set = with_setting(model, setting);
  const auto simulation = make_cpu_simulation(set, find_solver(setting.solver), setting.precision);
  if (start) simulation->write(*start);
  Trajectory trajectory{simulation->read()};
  run_for(*simulation, time_s, [&](std::uint64_t, std::uint64_t, const FrameStats&) {
    if (stop && stop()) throw Error(Exit::interrupted, "interrupted");
    trajectory.push_back(simulation->read());
    return true;
  });
  return trajectory;
}

double frame_distance(const State& a, const State& b) {
  const double distance_m = rms_distance(a, b);
  return std::isfinite(distance_m) ? distance_m : kNotFinite_m;
}

double trajectory_distance(const Trajectory& a, const Trajectory& b) {
  if (a.size() != b.size()) return kNotFinite_m;
  double largest_m = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) largest_m = std::max(largest_m, frame_distance(a[f], b[f]));
  return largest_m;
}

double resolution_distance(const Grid& coarse_grid, const State& coarse, const Grid& fine_grid,
                           const State& fine) {
  double sum = 0.0;
  for (std::uint32_t row = 0; row < coarse_grid.rows(); ++row) {
    const std::uint32_t j = coarse_grid.own_row(row), cloth = row / coarse_grid.ny;
    const Place v = place_on(j * coarse_grid.spacing_m, fine_grid.spacing_m, fine_grid.ny);
    for (std::uint32_t i = 0; i < coarse_grid.nx; ++i) {
      const Place u = place_on(i * coarse_grid.spacing_m, fine_grid.spacing_m, fine_grid.nx);
      const glm::dvec3 d =
          coarse.position[coarse_grid.index(i, row)] - position_at(fine_grid, fine, cloth, u, v);
      sum += glm::dot(d, d);
    }
  }
  const double distance_m = std::sqrt(sum / coarse_grid.count());
  return std::isfinite(distance_m) ? distance_m : kNotFinite_m;
}

}  // namespace weft::study
