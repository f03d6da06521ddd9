// A hanging strip on two grids, as exactly as double computes it; closed_forms_test.cpp has the other
// statics.
#include <gtest/gtest.h>

#include "model/measures.h"
#include "support/run.h"

namespace weft {
namespace {

using namespace testing_support;

// Stretch = ρ g L²/(2 k_s), k_s = 3Y/4, exactly: the half-mass end row makes the discrete factor 1.
TEST(Strip, StretchesUnderItsWeight) {
  for (const std::uint32_t rows : {5u, 17u}) {
    Scene scene = bare_scene(3, rows, 0.8 / (rows - 1));
    scene.material.flex = 0.0;
    scene.material.shear_n_m = 0.0;
    scene.gravity = GravitySection{};
    const Model model = pin_where(build_model(scene), [](auto, auto j) { return j == 0; });
    // The slowest mode along the strip: (π/2L)·√(k_s/ρ) = 120 /s.
    const State rest = settle(model, 240.0, 0.5);
    const double length_m = rest.position[1].y - rest.position[model.grid.index(1, rows - 1)].y;
    const double expected_m = 0.2 * 9.81 * 0.8 * 0.8 / (2 * 750.0);
    EXPECT_NEAR(length_m - 0.8, expected_m, 1e-6 * expected_m) << rows;
  }
}

}  // namespace
}  // namespace weft
