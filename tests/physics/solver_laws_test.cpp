// Laws that each solver of the list is held to: falling, momenta, the stable step, damping's order,
// precision.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "core/error.h"
#include "model/measures.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

// A constant acceleration: second-order schemes are exact, first-order ones are ½g·h·t early or late.
TEST(EverySolver, FallsAsItsOrderSays) {
  Scene scene = bare_scene(9, 7, 0.1);
  scene.material.membrane_n_m = 10.0;
  scene.material.bend_n_m = 1e-4;
  scene.gravity = GravitySection{};
  const Model model = build_model(scene);
  const State start = start_state(model);
  const double t = 0.5, h = 1.0 / 60 / 20;
  for (const Solver* solver : solvers()) {
    const State end = run_frames(model, start, solver->name, "f64", 30, 1.0 / 60, 20);
    const double late_m = solver->order > 1 ? 0.0 : 0.5 * 9.81 * h * t;
    for (std::size_t p = 0; p < end.position.size(); ++p) {
      const double fallen_m = start.position[p].y - end.position[p].y;
      EXPECT_NEAR(std::abs(fallen_m - 0.5 * 9.81 * t * t), late_m, 1e-9) << solver->name;
      EXPECT_NEAR(end.velocity[p].y, -9.81 * t, 1e-9) << solver->name;
    }
  }
}

// v_t(1 − e^{−αt}): exact where the kick is, and to the method's order where air is an ordinary force.
TEST(EverySolver, ReachesItsTerminalVelocity) {
  Scene scene = bare_scene(5, 5, 0.1);
  scene.material.membrane_n_m = 10.0;
  scene.gravity = GravitySection{};
  scene.air = AirSection{0.4};
  const Model model = build_model(scene);
  const double alpha = 2.0, v_m_s = 9.81 / alpha * (1 - std::exp(-alpha * 0.5));
  for (const Solver* solver : solvers()) {
    const State end = run_frames(model, start_state(model), solver->name, "f64", 30, 1.0 / 60, 20);
    const double tolerance = solver->rows_per_substep > 1 ? 1e-5 : 1e-9;
    EXPECT_NEAR(end.velocity[7].y, -v_m_s, tolerance) << solver->name;
  }
}

// What acts between particles moves their sum by round-off only. Angular momentum is kept besides by the
// schemes whose kicks are along the springs' own lines.
TEST(EverySolver, KeepsMomentum) {
  Scene scene = bare_scene(12, 9, 0.1);
  scene.material.bend_n_m = 0.01;
  const Model model = build_model(scene);
  State start = start_state(model);
  shake(start, 0.02, 1.0, 17);
  const glm::dvec3 p0 = linear_momentum(model, start), l0 = angular_momentum(model, start);
  const std::uint32_t n = 4 * substeps_per_frame(model, find_solver("leapfrog"));
  for (const Solver* solver : solvers()) {
    if (solver == &find_solver("euler")) continue;  // has diverged by then
    const State end = run_frames(model, start, solver->name, "f64", 10, 1.0 / 60, n);
    EXPECT_LE(glm::distance(linear_momentum(model, end), p0), 1e-12) << solver->name;
    EXPECT_GE(max_distance(start, end), 0.01) << solver->name << ": nothing moved";
    if (solver->rows_per_substep > 1 || solver == &find_solver("xpbd")) continue;
    EXPECT_LE(glm::distance(angular_momentum(model, end), l0), 1e-12) << solver->name;
  }
}

/// One particle on one spring, the corner of a cell whose other corners are pinned; ω and γ are known.
struct Oscillator {
  Model model;
  double omega_1_s, gamma_1_s;
  explicit Oscillator(double damping_s) {
    Scene scene = bare_scene(2, 2, 0.1);
    scene.material.shear_n_m = 0.0;
    scene.material.flex = 0.0;
    scene.material.damping_s = damping_s;
    scene.material.damping_ratio_max = 10.0;
    model = pin_where(build_model(scene), [](std::uint32_t i, std::uint32_t j) { return i + j < 2; });
    const double w = model.inverse_mass(3);  // half the weight: the spring lies on the boundary
    omega_1_s = std::sqrt(0.5 * model.springs[kStructuralI].stiffness_n_m * w);
    gamma_1_s = 0.5 * model.springs[kStructuralI].damping_n_s_m * w;
  }
  /// Its swing after 20000 steps of h over its first swing.
  double growth(std::string_view solver, double h_s) const {
    State state = start_state(model);
    state.position[3].x += 1e-6;
    const double rest_x = start_state(model).position[3].x;
    double largest = 0.0;
    const auto simulation = make_cpu_simulation(model, find_solver(solver), "f64");
    simulation->write(state);
    for (int f = 0; f < 200 && largest < 1.0; ++f) {
      simulation->advance(100 * h_s, 100);
      const double x = simulation->read().position[3].x;
      largest = std::isfinite(x) ? std::abs(x - rest_x) : 1.0;
    }
    return largest / 1e-6;
  }
};

// The rules of docs/physics.md are sharp for one oscillator: just below they hold, just above they do not.
TEST(StepRule, IsSharpForOneOscillator) {
  for (const double damping_s : {0.0, 1e-4, 1e-3}) {
    const Oscillator one(damping_s);
    const StepBound bound{one.omega_1_s * one.omega_1_s, one.gamma_1_s};
    for (const char* solver : {"leapfrog", "symplectic-euler", "verlet", "velocity-verlet"}) {
      const double h_s = find_solver(solver).step_max_s(bound);
      EXPECT_LE(one.growth(solver, 0.99 * h_s), 20.0) << solver << " damping " << damping_s;
      EXPECT_GE(one.growth(solver, 1.03 * h_s), 1e4) << solver << " damping " << damping_s;
    }
    EXPECT_LE(one.growth("rk4", find_solver("rk4").step_max_s(bound)), 1.01) << damping_s;
    EXPECT_LE(one.growth("xpbd", 10.0 / one.omega_1_s), 1.01) << "XPBD has no limit";
  }
  const Oscillator undamped(0.0);
  EXPECT_GE(undamped.growth("rk4", 2.9 / undamped.omega_1_s), 1e4);  // the limit is 2√2/ω
  EXPECT_GE(undamped.growth("euler", 0.1 / undamped.omega_1_s), 1e4);
  // (ωh)⁴/8 a step, 20000 steps: a factor 1.016 at ωh = 0.05, beyond all bounds at 0.5.
  EXPECT_LE(undamped.growth("trapezoid", 0.05 / undamped.omega_1_s), 1.02);
  EXPECT_GE(undamped.growth("trapezoid", 0.5 / undamped.omega_1_s), 1e4);
}

Model damped_swing() {
  Scene scene;
  scene.cloth.resolution = 9;
  scene.cloth.orientation = Orientation::horizontal;
  scene.cloth.imperfection_m = 0.01;
  scene.material.membrane_n_m = 100.0;
  scene.material.bend_n_m = 1e-3;
  scene.material.damping_s = 3e-3;
  scene.material.damping_ratio_max = 0.5;
  scene.gravity = GravitySection{};
  scene.air = AirSection{0.1};
  scene.pins = {{{0, 0}, 0.05}, {{1, 0}, 0.05}};
  return build_model(scene);
}

// With spring damping leapfrog is first order, because its forces see a velocity half a step old; velocity
// Verlet predicts it and stays second order, as Runge-Kutta stays what it is.
TEST(Damping, KeepsTheOrderOfThoseThatPredict) {
  const Model model = damped_swing();
  const State start = start_state(model);
  const State truth = run_frames(model, start, "rk4", "f64", 1, 0.1, 8000);
  const auto order = [&](const char* solver, std::uint32_t n) {
    const double coarse_m = rms_distance(run_frames(model, start, solver, "f64", 1, 0.1, n), truth);
    const double fine_m = rms_distance(run_frames(model, start, solver, "f64", 1, 0.1, 2 * n), truth);
    return std::log2(coarse_m / fine_m);
  };
  EXPECT_NEAR(order("velocity-verlet", 800), 2.0, 0.15);
  EXPECT_NEAR(order("trapezoid", 800), 2.0, 0.15);
  EXPECT_NEAR(order("rk4", 400), 4.0, 0.15);
  EXPECT_NEAR(order("leapfrog", 3200), 1.0, 0.15);
}

// A state keeps what float positions cannot hold: f32k reads back to 48 bits of what was written.
TEST(Compensation, StatesSurviveWriteAndRead) {
  const Model model = damped_swing();
  State state = start_state(model);
  shake(state, 0.1, 0.0, 8);
  const auto plain = make_cpu_simulation(model, find_solver("leapfrog"), "f32");
  const auto compensated = make_cpu_simulation(model, find_solver("leapfrog"), "f32k");
  plain->write(state);
  compensated->write(state);
  EXPECT_GE(max_distance(plain->read(), state), 1e-9);
  EXPECT_LE(max_distance(compensated->read(), state), 1e-14);
}

TEST(Compensation, IsRefusedWhereASolverHasNone) {
  const Model model = damped_swing();
  for (const Solver* solver : solvers()) {
    if (has_compensated(*solver)) {
      EXPECT_NO_THROW(make_cpu_simulation(model, *solver, "f32k")) << solver->name;
      continue;
    }
    try {
      make_cpu_simulation(model, *solver, "f32k");
      FAIL() << solver->name;
    } catch (const Error& refused) {
      EXPECT_EQ(refused.code(), Exit::usage);
      EXPECT_NE(std::string(refused.what()).find("velocity-verlet"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace weft
