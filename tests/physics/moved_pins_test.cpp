// Pins that move by keys: where they are, how fast, what the cloth feels of it, and that it stays stable.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "model/measures.h"
#include "model/motion.h"
#include "scene/reader.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

/// Hung by its whole top row, which moves by the keys.
Model towed(std::uint32_t columns, MotionKeys keys, const char* solver = "leapfrog") {
  Scene scene = bare_scene(columns, columns, 1.0 / (columns - 1));
  scene.pins = {{{0.0, 0.0}, 0.01, keys}, {{1.0, 0.0}, 0.01, keys}};
  scene.solver.name = solver;
  return build_model(scene);
}

// 10 s of swinging: the pins' places are those of the keys to one rounding of a float, however long it goes
// on.
TEST(MovedPins, AreWhereTheirKeysSayWithoutDrift) {
  MotionKeys keys;
  for (int k = 0; k <= 100; ++k) keys.push_back({0.1 * k, {0.3 * (k % 2), 0.1 * (k % 3), -0.7 * (k % 2)}});
  for (const Solver* solver : solvers()) {
    if (solver->name == "euler" || solver->name == "trapezoid") continue;  // diverge in that time
    const Model model = towed(6, keys, solver->name.data());
    ASSERT_EQ(model.moved_particles.size(), 2u);
    const auto simulation = make_cpu_simulation(model, *solver, "f32");
    for (int frame = 0; frame < 600; ++frame) simulation->advance(1.0 / 60, simulation->plan().substeps);
    const State now = simulation->read();
    for (const MovedParticle& held : model.moved_particles) {
      const glm::dvec3 meant_m = held.anchor_m + place_at(keys, now.time_s);
      EXPECT_LE(glm::distance(now.position[held.particle], meant_m), 2e-7) << solver->name;
    }
  }
}

// Galileo: pulled steadily, a cloth that starts with that velocity moves as one at rest does, from the
// pulling hand's point of view. Damping sees the pins' velocity, or it would brake; springs their place, or
// they would pull.
TEST(MovedPins, SteadyPullIsRestInAnotherFrame) {
  const glm::dvec3 pull_m_s(0.8, -0.5, 2.0);
  for (const Solver* solver : solvers()) {
    const Model moving = towed(8, {{0.0, glm::dvec3(0)}, {10.0, 10.0 * pull_m_s}}, solver->name.data());
    const Model resting = towed(8, {{0.0, glm::dvec3(0)}}, solver->name.data());
    State start = start_state(resting);
    shake(start, 0.01, 0.3, 7);
    for (std::uint32_t p = 0; p < moving.grid.count(); ++p)
      if (moving.relative_inverse_mass[p] == 0.0) {
        start.position[p] = start_state(resting).position[p];
        start.velocity[p] = glm::dvec3(0.0);
      }
    State carried = start;
    for (glm::dvec3& v : carried.velocity) v += pull_m_s;
    // Explicit Euler grows round-off by (wh)^2/2 a step: twenty times the substeps keep it far below the
    // bound.
    const std::uint32_t n = substeps_per_frame(resting, *solver) * (solver->name == "euler" ? 20 : 1);
    const State a = run_frames(resting, start, solver->name, "f64", 6, 1.0 / 60, n);
    const State b = run_frames(moving, carried, solver->name, "f64", 6, 1.0 / 60, n);
    for (std::size_t p = 0; p < a.position.size(); ++p) {
      EXPECT_LE(glm::distance(a.position[p] + 0.1 * pull_m_s, b.position[p]), 1e-8) << solver->name;
      EXPECT_LE(glm::distance(a.velocity[p] + pull_m_s, b.velocity[p]), 1e-5) << solver->name;
    }
  }
}

// Ten metres in one frame, with a cloth of one metre, and back: a large stretch while it lasts, as there must
// be, and afterwards the hanging cloth again.
TEST(MovedPins, AYankFarBeyondTheClothStaysStable) {
  const double frame_s = 1.0 / 60;
  const MotionKeys keys{
      {frame_s, {0, 0, 0}}, {2 * frame_s, {0, 0, 10}}, {4 * frame_s, {0, 0, 10}}, {0.5, {0, 0, 0}}};
  for (const char* solver : {"leapfrog", "velocity-verlet", "symplectic-euler", "verlet", "rk4", "xpbd"}) {
    Model model = towed(10, keys, solver);
    model.scene.gravity = GravitySection{};
    model.scene.air = AirSection{0.8};
    const auto simulation = make_cpu_simulation(model, find_solver(solver), "f32");
    double most = 0.0;
    for (int frame = 0; frame < 240; ++frame) {
      simulation->advance(frame_s, simulation->plan().substeps);
      const State now = simulation->read();
      ASSERT_TRUE(all_finite(now)) << solver << ", frame " << frame;
      most = std::max(most, stretch(model, now).maximum);
    }
    EXPECT_GT(most, 1.0) << solver << ": the pins ran ahead of the cloth";
    EXPECT_LE(stretch(model, simulation->read()).maximum, 0.2) << solver << ": it hangs again";
  }
}

TEST(MovedPins, AParticleOfSeveralPinsIsTheFirstOnes) {
  Scene scene = bare_scene(5, 5, 0.1);
  const MotionKeys up{{0.0, {0, 1, 0}}}, down{{0.0, {0, -1, 0}}};
  scene.pins = {{{0.0, 0.0}, 0.05, {}}, {{0.0, 0.0}, 0.11, up}, {{0.25, 0.0}, 0.11, down}};
  const Model model = build_model(scene);
  std::vector<std::uint32_t> particle, pin;
  for (const MovedParticle& held : model.moved_particles) {
    particle.push_back(held.particle);
    pin.push_back(held.pin);
  }
  // The corner stays; its neighbours (1 and 5) go up; what only the third pin holds (2 and 6) goes down.
  EXPECT_EQ(particle, (std::vector<std::uint32_t>{1, 2, 5, 6}));
  EXPECT_EQ(pin, (std::vector<std::uint32_t>{0, 1, 0, 1}));
  const State start = start_state(model);
  EXPECT_EQ(start.position[0].y, 0.2);
  EXPECT_EQ(start.position[1].y, 1.2);
  EXPECT_EQ(start.position[2].y, -0.8);
}

// What moves costs its own particles' bytes; what does not move costs nothing.
TEST(MovedPins, AreInThePlanOnlyWhereAPinHasKeys) {
  for (const Solver* solver : solvers()) {
    const Plan without = compile_plan(towed(8, {}), *solver);
    for (const PlanStep& step : without.steps)
      EXPECT_TRUE(step.pass != &pin_place && step.pass != &xpbd_pins) << solver->name;
    for (const PlanBuffer& buffer : without.buffers) EXPECT_NE(buffer.id, BufferId::moved_pins);
    const Plan with = compile_plan(towed(8, {{0.0, {0, 0, 0}}}), *solver);
    EXPECT_GT(with.steps.size(), without.steps.size()) << solver->name;
    std::uint64_t bytes = 0;
    for (const PlanBuffer& buffer : with.buffers)
      if (buffer.id == BufferId::moved_pins) bytes = buffer.bytes;
    EXPECT_EQ(bytes, 2u * 20u) << solver->name << ": two particles of 20 bytes";
  }
}

// A state that comes from elsewhere finds its pins where they are at its time.
TEST(MovedPins, AStateOfAnyTimeHasThemInPlace) {
  const Model model = towed(6, {{1.0, {0, 0, 0}}, {2.0, {0, 3, 0}}});
  State state = start_state(model);
  state.time_s = 1.5;
  place_moved_pins(model, state);
  EXPECT_EQ(state.position[0], model.moved_particles[0].anchor_m + glm::dvec3(0, 1.5, 0));
  EXPECT_EQ(state.velocity[0], glm::dvec3(0, 3, 0));
}

}  // namespace
}  // namespace weft
