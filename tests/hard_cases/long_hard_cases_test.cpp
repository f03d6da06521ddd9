// All solvers on all hard cases, on the CPU reference and on a device; and a fine stiff cloth on a sphere.
#include "hard_cases/judge.h"
#include "scene/reader.h"

namespace weft::hard {
namespace {

class LongHardCasesTest : public JudgedTest {};

TEST_F(LongHardCasesTest, EverySolverStaysFiniteOrIsFoundOut) {
  for (const HardCase& c : hard_cases())
    for (const Solver* solver : solvers()) {
      if (!what_solver_lacks(c, *solver).empty()) continue;
      judge_other(c, run_hard_case(c, *solver, on_cpu()), solver->name, "CPU");
      if (solver->on_gpu) judge_other(c, run_hard_case(c, *solver, on_device()), solver->name, "device");
    }
}

TEST_F(LongHardCasesTest, TheDefaultSolverHoldsInTheLongCasesToo) {
  for (const HardCase& c : hard_cases())
    if (!c.quick || !c.quick_on_device)
      judge_default(c, run_hard_case(c, held_solver(c), on_device()), "device");
}

// 1024² at 20 kN/m for 0.1 s: 75 billion particle-substeps, in six frames of some 12 000 substeps. A software
// device would take half an hour where the CPU's vector units, with the same bits, take some minutes.
TEST_F(LongHardCasesTest, FineAndStiffForATenthOfASecond) {
  const HardCase fine{.name = "fine",
                      .about = "1024 x 1024, stiff",
                      .scene = "fine",
                      .time_s = 0.1,
                      .closed = true,
                      .one_collider = true,
                      .quick = false};
  if (device().info().software)
    judge_default(fine, run_hard_case(fine, find_solver("leapfrog"), natively()), "vector units");
  else
    judge_default(fine, run_hard_case(fine, find_solver("leapfrog"), on_device()), "device");
}

// Scene 1 with gusts, ten simulated minutes: pins do not move by a bit, energy stays that of a cloth in wind,
// and nothing more is allocated or recorded after the first second than after the last.
TEST_F(LongHardCasesTest, TenMinutesOfGustsChangeNothingThatShouldStay) {
  const Model model = build_model(
      load_scene(find_scene("1"), {{"cloth.resolution=32", "wind.gust=0.8", "wind.period=1.7"}}).scene);
  const auto simulation = GpuSimulation::create(device(), model, find_solver("leapfrog"));
  const State start = simulation->read();
  const auto minute = [&](int frames) {
    double most_j = 0.0;
    for (int f = 0; f < frames; ++f) {
      simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
      if (f % 60 == 0) most_j = std::max(most_j, std::abs(energy(model, simulation->read()).total()));
    }
    return most_j;
  };
  const double first_j = minute(3600);
  const std::uint64_t live_bytes = device().allocator().live_bytes();
  double most_j = 0.0;
  for (int m = 1; m < 10; ++m) most_j = std::max(most_j, minute(3600));
  EXPECT_LT(most_j, 1.5 * first_j);
  EXPECT_EQ(device().allocator().live_bytes(), live_bytes);
  EXPECT_FALSE(simulation->divergence());
  const State end = simulation->read();
  EXPECT_NEAR(end.time_s, 600.0, 1e-6);
  for (std::size_t p = 0; p < start.position.size(); ++p)
    if (model.relative_inverse_mass[p] == 0.0) {
      EXPECT_EQ(end.position[p], start.position[p]) << p;
    }
  EXPECT_TRUE(all_finite(end));
}

}  // namespace
}  // namespace weft::hard
