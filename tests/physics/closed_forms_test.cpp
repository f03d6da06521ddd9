// Every closed form of docs/physics.md for every solver that it applies to, in double on the CPU reference.
// Falls, drag and momenta for all of them are in solver_laws_test.cpp.
#include "closed_forms.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace weft::closed_forms {
namespace {

Runner in_double(const Solver* solver) {
  return {solver, [solver](const Model& model, const State& start, int frames, double frame_s,
                           std::uint32_t substeps) {
            return testing_support::run_frames(model, start, solver->name, "f64", frames, frame_s, substeps);
          }};
}

Runner in_double(std::string_view name) { return in_double(&find_solver(name)); }

/// The solvers but the named ones, in double.
std::vector<Runner> solvers_but(std::initializer_list<std::string_view> left_out) {
  std::vector<Runner> runners;
  for (const Solver* solver : solvers())
    if (std::find(left_out.begin(), left_out.end(), solver->name) == left_out.end())
      runners.push_back(in_double(solver));
  return runners;
}

// Explicit Euler has no rest: what is stiff grows in it faster than air slows it. One sweep of XPBD leaves
// its constraints unsolved by an amount of first order in the step.
TEST(ClosedForms, AHungStripStretches) {
  for (const Runner& runner : solvers_but({"euler", "xpbd"}))
    EXPECT_LE(strip_error(runner), 1e-6) << runner.solver->name;
  EXPECT_LE(strip_error(in_double("xpbd")), 0.01);
}

TEST(ClosedForms, ACantileverDropsAsTheElastica) {
  for (const Runner& runner : solvers_but({"euler", "xpbd"}))
    for (const auto& [gamma, drop] : kElastica)
      EXPECT_LE(cantilever_error(runner, gamma, drop), 0.01) << runner.solver->name << " gamma " << gamma;
}

// 4 % at leapfrog's substeps: bending is stiff, and one sweep of XPBD too soft. It comes nearer with each
// more.
TEST(ClosedForms, XpbdsCantileverComesNearerWithSubsteps) {
  Runner finer = in_double("xpbd");
  const auto once = finer.run;
  finer.run = [once](const Model& model, const State& start, int frames, double frame_s,
                     std::uint32_t substeps) { return once(model, start, frames, frame_s, 4 * substeps); };
  const auto [gamma, drop] = kElastica[1];
  const double coarse = cantilever_error(in_double("xpbd"), gamma, drop);
  EXPECT_LE(coarse, 0.06);
  EXPECT_LE(cantilever_error(finer, gamma, drop), 0.5 * coarse);
}

// At ωh = 0.01 a scheme of second order is off by 1e-4 at most; one of first order by ωh/2 in phase, and
// explicit Euler and XPBD by ½ωh·ωt = 0.02 in amplitude, one too large, the other too small.
TEST(ClosedForms, AMembraneSwingsInItsModes) {
  for (const Runner& runner : solvers_but({}))
    for (const auto& [m, n] : {std::pair{1, 1}, {1, 2}, {3, 2}})
      EXPECT_LE(membrane_error(runner, m, n), runner.solver->order > 1 ? 2e-4 : 0.02)
          << runner.solver->name << " mode " << m << n;
}

// Half a percent of the frequency covers 64 cells and the strip's own stretch. Without damping the stiff
// modes along the chain grow in explicit Euler and in Heun's method, whatever the step.
TEST(ClosedForms, AHangingChainSwingsInItsModes) {
  for (const Runner& runner : solvers_but({"euler", "trapezoid"}))
    for (const double zero : kBesselZeros)
      EXPECT_LE(chain_error(runner, zero), 0.005 * 1.5 * std::numbers::pi) << runner.solver->name << zero;
}

// tan θ > μ = ½ slips with g(sin θ − μ cos θ); below, what is left is a creep of one substep's fall a
// substep.
TEST(ClosedForms, AnInclineHoldsBelowTheCoulombAngle) {
  const double steep = std::atan(0.55), flat = std::atan(0.45), h_s = 1.0 / 60 / 200;
  const double slip_m = 0.125 * 9.81 * (std::sin(steep) - 0.5 * std::cos(steep));
  for (const Runner& runner : solvers_but({})) {
    EXPECT_NEAR(slid_m(runner, steep), slip_m, 0.005 * slip_m) << runner.solver->name;
    EXPECT_LE(slid_m(runner, flat), 1.05 * 9.81 * std::sin(flat) * h_s * 0.5) << runner.solver->name;
  }
}

// Released at rest from the exact equilibrium the cloth stays. XPBD's own rest is another, too soft, one.
TEST(ClosedForms, AClothAtItsEquilibriumStays) {
  for (const Runner& runner : solvers_but({"euler", "xpbd"}))
    EXPECT_LE(rest_drift_m(runner), 1e-9) << runner.solver->name;
  EXPECT_LE(rest_drift_m(in_double("xpbd")), 5e-3);
}

}  // namespace
}  // namespace weft::closed_forms
