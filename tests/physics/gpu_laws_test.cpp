// The closed forms of docs/physics.md on the Vulkan device, for the default: leapfrog in single precision.
#include <gtest/gtest.h>

#include "closed_forms.h"
#include "gpu_fixture.h"
#include "sim/gpu_simulation.h"

namespace weft::test {
namespace {

using namespace closed_forms;

class GpuLaws : public GpuTest {
 protected:
  /// The default solver on the device; pipelines are shared by the runs of a test.
  static Runner on_device() {
    const auto pipelines = std::make_shared<GpuPipelines>(device());
    return {&find_solver("leapfrog"), [pipelines](const Model& model, const State& start, int frames,
                                                  double frame_s, std::uint32_t substeps) {
              Model timed = model;
              timed.scene.solver.substeps = substeps;  // what its frame has room for
              const auto simulation = GpuSimulation::create(device(), timed, find_solver("leapfrog"),
                                                            {.perturb = {}, .pipelines = pipelines});
              simulation->write(start);
              for (int f = 0; f < frames; ++f) simulation->advance(frame_s, substeps);
              return simulation->read();
            }};
  }
};

// Sums of 600 steps in float: 2e-5 m, as on the CPU (laws_test.cpp).
TEST_F(GpuLaws, free_fall_and_terminal_velocity) {
  const FallError error = fall_error(on_device());
  EXPECT_LE(error.fall_m, 2e-5);
  EXPECT_LE(error.drag_m_s, 2e-5);
}

TEST_F(GpuLaws, a_hung_strip_stretches_by_its_weight) { EXPECT_LE(strip_error(on_device()), 1e-3); }

TEST_F(GpuLaws, a_cantilever_drops_as_the_elastica_within_1_percent) {
  const Runner runner = on_device();
  for (const auto& [gamma, drop] : kElastica)
    EXPECT_LE(cantilever_error(runner, gamma, drop), 0.01) << "gamma " << gamma;
}

TEST_F(GpuLaws, a_membrane_and_a_chain_swing_in_their_modes) {
  const Runner runner = on_device();
  for (const auto& [m, n] : {std::pair{1, 1}, {1, 2}, {3, 2}})
    EXPECT_LE(membrane_error(runner, m, n), 5e-4) << "mode " << m << n;
  for (const double zero : kBesselZeros)
    EXPECT_LE(chain_error(runner, zero), 0.005 * 1.5 * std::numbers::pi) << zero;
}

// One corner of a cell on one spring of weight ½ swings by cos(ω_num·t), ω_num = (2/h)·asin(ωh/2), up to the
// stability limit.
TEST_F(GpuLaws, the_phase_error_of_one_oscillator_is_leapfrogs) {
  constexpr double kSpacing_m = 0.1, kSwing_m = 0.01;
  Scene scene = bare_scene(2, 2, kSpacing_m);
  scene.material.flex = scene.material.damping_s = 0.0;
  scene.material.shear_n_m = 0.0;
  const Model model = pin_where(build_model(scene), [](auto, auto j) { return j == 0; });
  State start = start_state(model);
  for (const std::uint32_t p : {2u, 3u}) start.position[p].y -= kSwing_m;
  const double omega_1_s = std::sqrt(2 * 750.0 / (0.2 * kSpacing_m * kSpacing_m));
  const Runner runner = on_device();
  for (const double omega_h : {0.1, 1.0, 1.9}) {
    const double h_s = omega_h / omega_1_s;
    const State end = runner.run(model, start, 1, 50 * h_s, 50);
    const double moved_m = start_state(model).position[2].y - end.position[2].y;
    EXPECT_NEAR(moved_m, kSwing_m * std::cos(100 * std::asin(omega_h / 2)), 1e-5) << omega_h;
  }
}

TEST_F(GpuLaws, both_momenta_stay_without_outside_force) {
  Scene scene = bare_scene(12, 9, 0.1);
  scene.material.bend_n_m = 0.01;
  const Model model = build_model(scene);
  State start = start_state(model);
  testing_support::shake(start, 0.02, 1.0, 17);
  const State end =
      on_device().run(model, start, 10, 1.0 / 60, substeps_per_frame(model, find_solver("leapfrog")));
  EXPECT_LE(glm::distance(linear_momentum(model, start), linear_momentum(model, end)), 1e-5);
  EXPECT_LE(glm::distance(angular_momentum(model, start), angular_momentum(model, end)), 1e-5);
  EXPECT_GE(max_distance(start, end), 0.01) << "nothing moved";
}

TEST_F(GpuLaws, an_incline_holds_below_the_coulomb_angle) {
  const double steep = std::atan(0.55), flat = std::atan(0.45), h_s = 1.0 / 60 / 200;
  const double slip_m = 0.125 * 9.81 * (std::sin(steep) - 0.5 * std::cos(steep));
  const Runner runner = on_device();
  EXPECT_NEAR(slid_m(runner, steep), slip_m, 0.005 * slip_m);
  EXPECT_LE(slid_m(runner, flat), 1.1 * 9.81 * std::sin(flat) * h_s * 0.5);
}

TEST_F(GpuLaws, a_cloth_at_its_equilibrium_stays_for_two_seconds) {
  EXPECT_LE(rest_drift_m(on_device()), 1e-6);
}

}  // namespace
}  // namespace weft::test
