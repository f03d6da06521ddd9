// The closed forms of docs/physics.md as measurements of whatever runs a cloth: how far a run is from each
// law.
#pragma once
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "model/measures.h"
#include "support/run.h"

namespace weft::closed_forms {

using testing_support::bare_scene;
using testing_support::pin_where;

/// Γ of docs/physics.md's elastica, with tip drop over tip reach.
inline constexpr std::pair<double, double> kElastica[] = {{1.0, 0.12456}, {5.0, 0.58572}, {20.0, 1.86393}};
inline constexpr double kBesselZeros[] = {2.4048, 5.5201, 8.6537};  ///< of J₀

/// A solver on some device: the state after `frames` frames of `frame_s` in `substeps` each, from `start`.
struct Runner {
  const Solver* solver;
  std::function<State(const Model&, const State& start, int frames, double frame_s, std::uint32_t substeps)>
      run;
};

/// Substeps a frame of 1/60 s at which the solver is stable and converged: its own automatic number, no less
/// than leapfrog's; four times that for Heun's method, whose growth (ωh)⁴/8 a step damping must outweigh.
inline std::uint32_t fine_substeps(const Runner& runner, const Model& model) {
  const std::uint32_t n =
      std::max(substeps_per_frame(model, *runner.solver), substeps_per_frame(model, find_solver("leapfrog")));
  return runner.solver->name == "trapezoid" ? 4 * n : n;
}

/// The cloth at rest, crept to by the runner itself through thick air.
/// @param rate_1_s  the drag's rate, best near twice the slowest mode's angular frequency
inline State crept(const Runner& runner, Model model, double rate_1_s, double time_s) {
  model.scene.air = AirSection{rate_1_s * model.scene.material.density_kg_m2};
  const double frame_s = model.scene.solver.frame_s;
  return runner.run(model, start_state(model), static_cast<int>(std::ceil(time_s / frame_s)), frame_s,
                    fine_substeps(runner, model));
}

/// Relative error of the stretch ρgL²/(2k_s) of a strip of eight cells hung by its top row.
inline double strip_error(const Runner& runner) {
  constexpr double kLength_m = 0.8;
  Scene scene = bare_scene(3, 9, kLength_m / 8);
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.membrane_n_m = 100.0;  // a stretch of 8 mm, far above float's last bit
  scene.gravity = GravitySection{};
  const Model model = pin_where(build_model(scene), [](auto, auto j) { return j == 0; });
  // The slowest mode along the strip: (π/2L)·√(k_s/ρ) = 38 /s.
  const State rest = crept(runner, model, 76.0, 0.7);
  const double expected_m = 0.2 * 9.81 * kLength_m * kLength_m / (2 * 75.0);
  const double length_m = rest.position[1].y - rest.position[model.grid.index(1, 8)].y;
  return std::abs(length_m - kLength_m - expected_m) / expected_m;
}

/// Relative error of tip drop over tip reach of a cantilever of 24 cells at Γ = ρ g L³/B. Two pinned rows
/// clamp it half a cell before the last of them.
inline double cantilever_error(const Runner& runner, double gamma, double drop) {
  constexpr std::uint32_t kRows = 26;
  constexpr double kLength_m = 0.5, kSpacing_m = kLength_m / 24.5;
  Scene scene = bare_scene(3, kRows, kSpacing_m);
  scene.cloth.orientation = Orientation::horizontal;
  scene.gravity = GravitySection{};
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.membrane_n_m = 2000.0;  // stretches by less than 1e-3
  scene.material.bend_n_m = 0.2 * 9.81 * std::pow(kLength_m, 3) / gamma;
  const Model model = pin_where(build_model(scene), [](auto, auto j) { return j < 2; });
  const double slowest_1_s = 3.516 / (kLength_m * kLength_m) * std::sqrt(scene.material.bend_n_m / 0.2);
  const State rest = crept(runner, model, 2 * slowest_1_s, 12 / slowest_1_s);
  const glm::dvec3 tip = rest.position[model.grid.index(1, kRows - 1)];
  const double clamp_z = rest.position[model.grid.index(1, 1)].z - 0.5 * kSpacing_m;
  return std::abs((rest.position[1].y - tip.y) / (tip.z - clamp_z) - drop) / drop;
}

/// Distance from cos 4 of a mode (m, n) of a membrane pretensioned by a tenth, at ωt = 4, over its amplitude.
inline double membrane_error(const Runner& runner, int m, int n) {
  constexpr std::uint32_t kCells = 12;
  constexpr double kStretch = 0.1, kAmplitude_m = 1e-3, kSpacing_m = 1.0 / kCells, kPi = std::numbers::pi;
  Scene scene = bare_scene(kCells + 1, kCells + 1, kSpacing_m);
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.damping_s = 0.0;
  const Model model = pin_where(
      build_model(scene), [](auto i, auto j) { return i == 0 || j == 0 || i == kCells || j == kCells; });
  const auto shape = [&](std::uint32_t p) {
    return std::sin(m * kPi * (p % (kCells + 1)) / kCells) * std::sin(n * kPi * (p / (kCells + 1)) / kCells);
  };
  State start = start_state(model);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
    start.position[p] *= 1 + kStretch;
    start.position[p].z = kAmplitude_m * shape(p);
  }
  const double sine_m = std::sin(m * kPi / 2 / kCells), sine_n = std::sin(n * kPi / 2 / kCells);
  const double tension_n_m = 750.0 * kStretch / (1 + kStretch);
  const double omega_1_s =
      std::sqrt(4 * tension_n_m / (0.2 * kSpacing_m * kSpacing_m) * (sine_m * sine_m + sine_n * sine_n));
  const State end = runner.run(model, start, 1, 4.0 / omega_1_s, 400);
  double projected = 0.0, norm = 0.0;
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
    projected += shape(p) * end.position[p].z;
    norm += shape(p) * shape(p);
  }
  return std::abs(projected / norm / kAmplitude_m - std::cos(4.0));
}

/// How far a hanging chain's mode J₀(2ω√(s/g)), ω = (zero/2)·√(g/L), is from zero after three quarters of its
/// period, over its amplitude: 3π/2 times the relative error of its frequency.
inline double chain_error(const Runner& runner, double zero) {
  constexpr std::uint32_t kRows = 65;
  Scene scene = bare_scene(2, kRows, 1.0 / (kRows - 1));
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.damping_s = 0.0;
  scene.gravity = GravitySection{};
  const Model model = pin_where(build_model(scene), [](auto, auto j) { return j == 0; });
  const auto shape = [&](std::uint32_t p) {
    return std::cyl_bessel_j(0.0, zero * std::sqrt(1.0 - double(p / 2) / (kRows - 1)));
  };
  State start = testing_support::settle(model, 200.0, 0.5);
  for (std::uint32_t p = 0; p < model.grid.count(); ++p) start.position[p].z += 1e-3 * shape(p);
  const auto projected = [&](const State& state) {
    double sum = 0.0;
    for (std::uint32_t p = 2; p < model.grid.count(); ++p)
      sum += shape(p) * state.position[p].z / model.relative_inverse_mass[p];
    return sum;
  };
  const double omega_1_s = zero / 2 * std::sqrt(9.81), time_s = 1.5 * std::numbers::pi / omega_1_s;
  const double frames = time_s / model.scene.solver.frame_s;
  const auto substeps = static_cast<std::uint32_t>(std::ceil(frames * fine_substeps(runner, model)));
  return std::abs(projected(runner.run(model, start, 1, time_s, substeps)) / projected(start));
}

/// Metres that a cloth slides in half a second down an incline of angle `angle`, friction ½.
inline double slid_m(const Runner& runner, double angle) {
  Scene scene = bare_scene(6, 6, 0.1);
  scene.cloth.orientation = Orientation::horizontal;
  scene.material.membrane_n_m = 10.0;
  scene.gravity = GravitySection{9.81 * glm::dvec3(std::sin(angle), -std::cos(angle), 0)};
  scene.floor = FloorSection{0.0, 0.5};
  const Model model = build_model(scene);
  const State start = start_state(model);
  return runner.run(model, start, 30, 1.0 / 60, 200).position[14].x - start.position[14].x;
}

/// Largest move of any particle [m] in two seconds from rest at the exact equilibrium of a hung cloth.
inline double rest_drift_m(const Runner& runner) {
  Scene scene;
  scene.cloth.resolution = 9;
  scene.cloth.orientation = Orientation::horizontal;
  scene.cloth.imperfection_m = 0.01;
  scene.material.bend_n_m = 1e-3;
  scene.gravity = GravitySection{};
  scene.pins = {{{0, 0}, 0.1}, {{1, 0}, 0.1}};
  const Model model = build_model(scene);
  static const State rest = testing_support::settle(model, 8.0, 40.0);
  const State end = runner.run(model, rest, 120, 1.0 / 60, fine_substeps(runner, model));
  return max_distance(rest, end);
}

/// Metres that a free cloth is from ½gt², and from v_t(1 − e^{−αt}) with α = 2 /s [m/s], after half a second.
struct FallError {
  double fall_m, drag_m_s;
};
inline FallError fall_error(const Runner& runner) {
  Scene scene = bare_scene(9, 7, 0.1);
  scene.material.membrane_n_m = 10.0;
  scene.gravity = GravitySection{};
  const Model model = build_model(scene);
  const State start = start_state(model);
  const State free = runner.run(model, start, 30, 1.0 / 60, 20);
  Scene thick = scene;
  thick.air = AirSection{0.4};
  const State slowed = runner.run(build_model(thick), start, 30, 1.0 / 60, 20);
  return {std::abs(start.position[5].y - free.position[5].y - 0.5 * 9.81 * 0.25),
          std::abs(slowed.velocity[5].y + 9.81 / 2.0 * (1 - std::exp(-1.0)))};
}

}  // namespace weft::closed_forms
