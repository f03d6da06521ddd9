// The strain limit on the device: the mirrors' bits, with every solver and precision that has it.
#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/validate.h"

namespace weft::test {
namespace {

class StrainLimitGpuTest : public GpuTest {};

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
    const ValidationReport report =
        validate(device(), model, find_solver(solver), {.lockstep_substeps = 20, .lockstep_frames = 1});
    std::size_t of_limit = 0;
    for (const ValidationRow& row : report.rows) {
      of_limit += row.check == "strain_limit" ? 1 : 0;
      EXPECT_TRUE(row.ok) << solver << " " << precision << ": " << row.check << ", " << row.state << ", "
                          << row.buffer << ": " << row.verdict << ", " << row.max_ulp << " ulp";
    }
    EXPECT_GT(of_limit, 0u);
  }
}

}  // namespace
}  // namespace weft::test
