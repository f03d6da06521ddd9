// The default solver on the hard cases, on the CPU reference and on a device: every run stays finite, and
// what contact, energy and momentum promise holds. The cases that take long, and all other solvers, are in
// long_hard_cases_test.cpp.
#include "hard_cases/judge.h"

namespace weft::hard {
namespace {

class HardCasesTest : public JudgedTest {};

TEST_F(HardCasesTest, LeapfrogStaysFiniteOnTheReference) {
  for (const HardCase& c : hard_cases())
    if (c.quick) judge_default(c, run_hard_case(c, held_solver(c), on_cpu()), "CPU");
}

TEST_F(HardCasesTest, LeapfrogStaysFiniteOnTheVectorUnits) {
  for (const HardCase& c : hard_cases())
    if (c.quick && native_lacks(hard_model(c), held_solver(c), "f32").empty())
      judge_default(c, run_hard_case(c, held_solver(c), natively()), "vector units");
}

TEST_F(HardCasesTest, LeapfrogStaysFiniteOnTheDevice) {
  for (const HardCase& c : hard_cases()) {
    if (!c.quick || !c.quick_on_device) continue;
    const Outcome outcome = run_hard_case(c, held_solver(c), on_device());
    judge_default(c, outcome, "device");
  }
}

// The start is what the law's law is measured on: a cloth of the case's particles is really there.
TEST(HardCaseListTest, SaysWhatItMeans) {
  for (const HardCase& c : hard_cases()) {
    const Model model = hard_model(c);
    const State start = hard_start(c, model);
    EXPECT_TRUE(all_finite(start)) << c.name;
    EXPECT_EQ(start.position.size(), model.grid.count()) << c.name;
    EXPECT_NE(c.about, "") << c.name;
  }
  const auto of = [](std::string_view name) {
    for (const HardCase& c : hard_cases())
      if (c.name == name) return hard_model(c);
    throw std::runtime_error("no such case");
  };
  EXPECT_EQ(of("2x4096").grid.ny, 4096u);
  EXPECT_EQ(of("4096x2").grid.nx, 4096u);
  EXPECT_EQ(of("4096x2").grid.ny, 2u);
  // A particle inside against one at a corner, which has a quarter of its area.
  std::vector<double> free;
  for (const double w : of("heavy-1e6").relative_inverse_mass)
    if (w != 0.0) free.push_back(w);
  EXPECT_NEAR(std::ranges::max(free) / std::ranges::min(free), 4e6, 1.0);
  const auto pinned = of("all-pinned").relative_inverse_mass;
  EXPECT_EQ(std::ranges::count(pinned, 0.0), static_cast<std::ptrdiff_t>(pinned.size()));
}

}  // namespace
}  // namespace weft::hard
