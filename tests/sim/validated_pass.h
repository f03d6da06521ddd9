// Validating a scene and counting the rows of one pass, on a device: the tests of effects share it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "gpu_fixture.h"
#include "sim/validate.h"

namespace weft::test {

class ValidatedPassTest : public GpuTest {
 protected:
  /// Validates, expects every row to hold, and returns how many rows are of a pass.
  std::size_t rows_of(const Model& model, const char* solver, std::string_view pass) {
    const ValidationReport report =
        validate(device(), model, find_solver(solver), {.lockstep_substeps = 20, .lockstep_frames = 1});
    std::size_t count = 0;
    for (const ValidationRow& row : report.rows) {
      count += row.check == pass ? 1 : 0;
      EXPECT_TRUE(row.ok) << solver << ": " << row.check << ", " << row.state << ", " << row.buffer << ": "
                          << row.verdict << ", " << row.max_ulp << " ulp";
    }
    return count;
  }
};

/// A pin on a sphere that flies, let go in the first frame, and one that holds nothing from the start.
inline const std::string kPinsThatLetGo = R"(
[[spheres]]
center = [-0.2, 0.9, 0.5]
radius = 0.15
velocity = [0.3, 0.1, 0.0]
[[pins]]
at = [1.0, 0.0]
radius = 0.1
attach = "spheres.0"
release = 0.004
[[pins]]
at = [0.5, 1.0]
radius = 0.1
release = 0.0
)";

}  // namespace weft::test
