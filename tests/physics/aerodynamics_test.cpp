// Drag and lift by triangle: terminal velocity, the exact fall, forces that only brake, and storms that blow
// nothing up.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "model/measures.h"
#include "scene/reader.h"
#include "support/run.h"

namespace weft {
namespace {

using testing_support::run_frames;

Model air_model(const std::string& more) {
  return build_model(parse_scene("[cloth]\nresolution = 6\nwidth = 0.5\nheight = 0.5\norientation = "
                                 "\"horizontal\"\n[material]\ndensity = 0.2\n" +
                                     more,
                                 "air.toml")
                         .scene);
}

glm::dvec3 mean_velocity(const State& state) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& v : state.velocity) sum += v;
  return sum / double(state.velocity.size());
}

const std::string kStiff =
    "membrane = 5000\nbend = 0.05\n";  // a plate rather than a cloth: it hardly billows

// A flat plate across the flow: ½·ρ_air·C_d·v² = ρ·g, from rest v = v_t·tanh(g·t/v_t). What is left is how
// far the plate's edges give way, and half a step's gravity.
TEST(Aerodynamics, AFlatPlateFallsAtItsTerminalVelocity) {
  const Model model =
      air_model(kStiff + "[gravity]\n[aerodynamics]\ndensity = 1.2\ndrag = 1.28\nlift = 0.7\n");
  const double terminal_m_s = std::sqrt(0.2 * 9.81 / (0.5 * 1.2 * 1.28));
  const std::uint32_t substeps = substeps_per_frame(model, find_solver("leapfrog"));
  for (const int frames : {10, 60}) {
    const State end = run_frames(model, start_state(model), "leapfrog", "f64", frames, 1.0 / 60, substeps);
    const double expected_m_s = terminal_m_s * std::tanh(9.81 * frames / 60.0 / terminal_m_s);
    EXPECT_NEAR(-mean_velocity(end).y, expected_m_s, 3e-3 * expected_m_s) << frames;
  }
}

// Without anything else the speed against the air only falls: v = v₀/(1 + k·v₀·t), k = ½ρ_air·C_d/ρ. Without
// lift the kick is that law, so that steps of 17 ms do as well as steps of 1.7 ms; XPBD takes any.
TEST(Aerodynamics, BrakesAFastPlateAsTheLawSaysAtAnyStep) {
  const Model model = air_model(kStiff + "[aerodynamics]\nlift = 0\n");
  State start = start_state(model);
  for (glm::dvec3& v : start.velocity) v = {0.0, -100.0, 0.0};
  const double k = 0.5 * 1.2 * 1.28 / 0.2, time_s = 0.1, expected_m_s = 100.0 / (1.0 + k * 100.0 * time_s);
  for (const std::uint32_t substeps : {6u, 60u}) {
    const State end = run_frames(model, start, "xpbd", "f64", 1, time_s, substeps);
    EXPECT_NEAR(-mean_velocity(end).y, expected_m_s, 0.05 * expected_m_s) << substeps;
  }
}

// The force never does work on a cloth that moves against still air, at any angle.
TEST(Aerodynamics, NeverGivesEnergy) {
  for (const double angle : {0.1, 0.7, 1.3, 1.57}) {
    const Model model = air_model("[aerodynamics]\nlift = 3\n");
    State start = start_state(model);
    for (glm::dvec3& v : start.velocity) v = 20.0 * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    const double before_j = energy(model, start).kinetic_j;
    const State end = run_frames(model, start, "leapfrog", "f32", 6, 1.0 / 60, 60);
    const Energy after = energy(model, end);
    EXPECT_LT(after.kinetic_j + after.elastic_j, before_j) << angle;
  }
}

// A flag in 100 m/s with gusts and eddies, with few and long substeps of XPBD and with leapfrog's own.
TEST(Aerodynamics, AStormBlowsNothingUp) {
  const std::string storm =
      "[[pins]]\nat = [0, 0]\n[[pins]]\nat = [0, 1]\n[gravity]\n[aerodynamics]\n[wind]\nvelocity = [100, 0, "
      "20]\n"
      "gust = 0.5\nperiod = 0.3\nnoise = 30\nnoise_scale = 0.2\nnoise_period = 0.1\n";
  const Model model = air_model(storm);
  for (const char* solver : {"leapfrog", "xpbd"}) {
    const State end = run_frames(model, start_state(model), solver, "f32", 30, 1.0 / 60,
                                 substeps_per_frame(model, find_solver(solver)));
    EXPECT_TRUE(all_finite(end)) << solver;
    for (const glm::dvec3& v : end.velocity) EXPECT_LT(glm::length(v), 400.0) << solver;
  }
}

// Another seed is another wind; the same seed is the same, to the bit.
TEST(Aerodynamics, TheSeedDecidesTheEddies) {
  const auto hash = [](int seed) {
    const Model model = air_model(fmt::format(
        "[aerodynamics]\n[wind]\nvelocity = [1, 0, 0]\nnoise = 3\nnoise_scale = 0.2\nseed = {}\n", seed));
    return state_hash(run_frames(model, start_state(model), "leapfrog", "f32", 3, 1.0 / 60, 20));
  };
  EXPECT_EQ(hash(1), hash(1));
  EXPECT_NE(hash(1), hash(2));
}

}  // namespace
}  // namespace weft
