// Oscillations with closed forms, as exactly as leapfrog computes them: its phase error, a membrane's modes.
#include <gtest/gtest.h>

#include <numbers>

#include "model/measures.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;
constexpr double kPi = std::numbers::pi;

Scene strings(std::uint32_t columns, std::uint32_t rows, double a) {
  Scene scene = bare_scene(columns, rows, a);
  scene.material.flex = 0.0;
  scene.material.shear_n_m = 0.0;
  scene.material.damping_s = 0.0;
  return scene;
}

// One oscillator: two masses m0/4 below two pinned ones, each on its spring of weight ½, so ω² = 2k_s/(ρa²).
// Leapfrog's solution is cos(ω_num·t), ω_num = (2/h)·asin(ωh/2), to round-off even near the stability limit.
TEST(Leapfrog, PhaseErrorIsExact) {
  const double a = 0.1, omega = std::sqrt(2 * 750.0 / (0.2 * a * a)), delta_m = 0.01;
  const Model model = pin_where(build_model(strings(2, 2, a)), [](auto, auto j) { return j == 0; });
  State start = start_state(model);
  for (const std::uint32_t p : {2u, 3u}) start.position[p].y -= delta_m;
  for (const double omega_h : {0.1, 1.0, 1.5, 1.9}) {
    const double h = omega_h / omega, omega_num = 2 / h * std::asin(omega_h / 2);
    for (const int steps : {7, 300}) {
      const State end =
          run_frames(model, start, "leapfrog", "f64", 1, steps * h, static_cast<std::uint32_t>(steps));
      const double moved_m = -0.5 * a - end.position[2].y;
      EXPECT_NEAR(moved_m, delta_m * std::cos(omega_num * h * steps), 1e-11) << omega_h << ", " << steps;
    }
  }
}

// Many frames are one long frame: the closing half kick and the next opening one make a whole.
TEST(Leapfrog, FramesJoinWithoutASeam) {
  Scene scene = strings(7, 6, 0.1);
  scene.gravity = GravitySection{};
  scene.pins = {{{0, 0}, 0.01}};
  const Model model = build_model(scene);
  State start = start_state(model);
  shake(start, 0.005, 0.1, 5);
  const State once = run_frames(model, start, "leapfrog", "f64", 1, 0.1, 200);
  const State often = run_frames(model, start, "leapfrog", "f64", 20, 0.005, 10);
  EXPECT_LE(max_distance(once, often), 1e-10);
}

// A membrane stretched by ε in its frame: ω² = (4T/(ρa²))·[sin²(mπ/2N) + sin²(nπ/2N)], T = k_s·ε/(1+ε).
TEST(Membrane, ModesOfAPretensionedSquare) {
  const std::uint32_t cells = 12;
  const double a = 1.0 / cells, stretch_ratio = 0.1, amplitude_m = 1e-5;
  const Model model = pin_where(build_model(strings(cells + 1, cells + 1, a)),
                                [&](auto i, auto j) { return i == 0 || j == 0 || i == cells || j == cells; });
  const double tension = 750.0 * stretch_ratio / (1 + stretch_ratio);
  for (const auto& [m, n] : {std::pair{1, 1}, {1, 2}, {3, 2}, {5, 5}}) {
    const auto shape = [&, mm = m, nn = n](std::uint32_t p) {
      return std::sin(mm * kPi * (p % (cells + 1)) / cells) * std::sin(nn * kPi * (p / (cells + 1)) / cells);
    };
    State start = start_state(model);
    for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
      start.position[p] *= 1 + stretch_ratio;
      start.position[p].z = amplitude_m * shape(p);
    }
    const double sum =
        std::pow(std::sin(m * kPi / 2 / cells), 2) + std::pow(std::sin(n * kPi / 2 / cells), 2);
    const double omega = std::sqrt(4 * tension / (0.2 * a * a) * sum), h = 0.1 / omega;
    const double omega_num = 2 / h * std::asin(omega * h / 2);
    for (const int steps : {40, 200}) {  // 0.6 and 3.2 periods
      const State end =
          run_frames(model, start, "leapfrog", "f64", 1, steps * h, static_cast<std::uint32_t>(steps));
      double projected = 0.0, norm = 0.0;
      for (std::uint32_t p = 0; p < model.grid.count(); ++p) {
        projected += shape(p) * end.position[p].z;
        norm += shape(p) * shape(p);
      }
      EXPECT_NEAR(projected / norm / amplitude_m, std::cos(omega_num * h * steps), 1e-4) << m << n << steps;
    }
  }
}

}  // namespace
}  // namespace weft
