// Two cloths for the tests that hold the device against the mirrors.
#pragma once
#include <gtest/gtest.h>

#include "gpu_fixture.h"
#include "scenes.h"
#include "sim/validate.h"

namespace weft::test {

/// Two cloths of 24 x 20 particles with all effects of the fused pass.
inline Model two_cloths(const std::string& more) {
  return full_model("[[cloths]]\ncenter = [0.1, 1.0, 0.12]\n[[pins]]\nat = [1, 0]\ncloth = 1\n" + more);
}

class ClothsGpu : public GpuTest {
 protected:
  void equal_their_mirrors(const char* solver, const char* precision, const std::string& more) {
    if (std::string(precision) == "f64" && !device().info().float64) return;
    const Model model = two_cloths(more + fmt::format("[solver]\nprecision = \"{}\"\n", precision));
    const ValidationReport report =
        validate(device(), model, find_solver(solver), {.lockstep_substeps = 10, .lockstep_frames = 1});
    EXPECT_FALSE(report.rows.empty());
    for (const ValidationRow& row : report.rows)
      EXPECT_TRUE(row.ok) << solver << " " << precision << ": " << row.check << ", " << row.state << ", "
                          << row.buffer << ": " << row.verdict << ", " << row.max_ulp << " ulp";
  }
};

inline const std::string kLayers = "[self_collision]\nthickness = 0.05\n", kAir = "[aerodynamics]\n";

}  // namespace weft::test
