// Running a small cloth on the CPU reference in the tests.
#pragma once
#include "sim/simulation.h"
#include "support/cloth.h"

namespace weft::testing_support {

/// The state after `frames` frames of `frame_s` in `substeps` substeps each, from `start`.
inline State run_frames(const Model& model, const State& start, std::string_view solver,
                        const char* precision, int frames, double frame_s, std::uint32_t substeps) {
  const auto simulation = make_cpu_simulation(model, find_solver(solver), precision);
  simulation->write(start);
  for (int f = 0; f < frames; ++f) simulation->advance(frame_s, substeps);
  return simulation->read();
}

/// The resting state of a cloth: the same one in air so thick that it creeps to its equilibrium.
/// @param rate_1_s  the drag's rate α, best near twice the slowest mode's angular frequency
inline State settle(const Model& model, double rate_1_s, double time_s) {
  Model thick = model;
  thick.scene.air = AirSection{rate_1_s * model.scene.material.density_kg_m2};
  thick.scene.wind.reset();
  const std::uint32_t n = substeps_per_frame(thick, find_solver("leapfrog"));
  const int frames = static_cast<int>(std::ceil(time_s / thick.scene.solver.frame_s));
  State rest =
      run_frames(thick, start_state(thick), "leapfrog", "f64", frames, thick.scene.solver.frame_s, n);
  for (glm::dvec3& v : rest.velocity) v = glm::dvec3(0.0);
  rest.time_s = 0.0;
  return rest;
}

}  // namespace weft::testing_support
