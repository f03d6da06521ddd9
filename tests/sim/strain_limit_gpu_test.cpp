// The strain limit on the device: the mirrors' bits, with every solver and precision that has it.
#include <gtest/gtest.h>

#include "scenes.h"
#include "validated_pass.h"

namespace weft::test {
namespace {

class StrainLimitGpuTest : public ValidatedPassTest {};

TEST_F(StrainLimitGpuTest, equals_its_mirror_with_every_solver_and_precision) {
  const std::pair<const char*, const char*> runs[] = {{"leapfrog", "f32"},
                                                      {"leapfrog", "f32k"},
                                                      {"leapfrog", "f64"},
                                                      {"symplectic-euler", "f32"},
                                                      {"xpbd", "f32"}};
  for (const auto& [solver, precision] : runs) {
    if (std::string(precision) == "f64" && !device().info().float64) continue;
    Scene scene = full_model(fmt::format("[solver]\nprecision = \"{}\"\n", precision)).scene;
    scene.material.strain_limit = 0.02;
    const Model model = build_model(scene);
    EXPECT_GT(rows_of(model, solver, "strain_limit"), 0u) << precision;
  }
}

}  // namespace
}  // namespace weft::test
