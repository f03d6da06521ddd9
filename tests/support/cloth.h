// Small cloths for the tests, built in code, and what tests ask of them: forces, random states, settled ones.
#pragma once
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "model/model.h"
#include "passes/passes.h"
#include "passes/tables.h"

namespace weft::testing_support {

/// A free cloth of `columns` × `rows` particles and spacing a, without gravity, air or colliders.
inline Scene bare_scene(std::uint32_t columns, std::uint32_t rows, double spacing_m) {
  Scene scene;
  scene.cloth.width_m = (columns - 1) * spacing_m;
  scene.cloth.height_m = (rows - 1) * spacing_m;
  scene.cloth.resolution = columns;
  return scene;
}

/// Every particle and velocity moved by up to the given amounts, from a fixed seed.
inline void shake(State& state, double position_m, double velocity_m_s, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto any = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  for (glm::dvec3& x : state.position) x += position_m * any();
  for (glm::dvec3& v : state.velocity) v += velocity_m_s * any();
}

/// Acceleration [m/s²] of every particle in double, as the integration pass evaluates it: one second's kick
/// without drift. Without air only.
inline std::vector<glm::dvec3> acceleration(const Model& model, const State& state) {
  HostBuffers<double> buffers;
  load_state(model, state, buffers);
  const Constants constants = integrate.constants(model);
  const KickDrift row{
      .kick_s = 1.0, .drift_s = 0.0, .kick_time_s = state.time_s, .drift_time_s = state.time_s};
  integrate.mirror_f64({model, constants, row, 0}, buffers);
  std::vector<glm::dvec3> result;
  for (std::size_t p = 0; p < state.position.size(); ++p)
    result.push_back(glm::dvec3(buffers[BufferId::velocity_next][p]) - state.velocity[p]);
  return result;
}

/// The same model with the chosen particles pinned: pinned(i, j).
template <class Pinned>
Model pin_where(const Model& model, Pinned&& pinned) {
  std::vector<double> scale(model.grid.count(), 1.0);
  for (std::uint32_t j = 0; j < model.grid.ny; ++j)
    for (std::uint32_t i = 0; i < model.grid.nx; ++i)
      if (pinned(i, j)) scale[model.grid.index(i, j)] = 0.0;
  return with_mass_scale(model, scale);
}

}  // namespace weft::testing_support
