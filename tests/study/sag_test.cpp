// The same cloth at every resolution: scene 2's sag at rest does not depend on how fine the grid is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "scene/reader.h"
#include "study/equilibrium.h"

namespace weft::study {
namespace {

/// A state of a grid with twice the cells: shared particles as they are, those between them halfway.
State refined(const Model& coarse, const std::vector<glm::dvec3>& x, const Model& fine) {
  State state = start_state(fine);
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return x[coarse.grid.index(i, j)]; };
  for (std::uint32_t j = 0; j < fine.grid.ny; ++j)
    for (std::uint32_t i = 0; i < fine.grid.nx; ++i) {
      const std::uint32_t p = fine.grid.index(i, j), i1 = (i + 1) / 2, j1 = (j + 1) / 2;
      if (fine.relative_inverse_mass[p] == 0.0) continue;
      state.position[p] = 0.25 * (at(i / 2, j / 2) + at(i1, j / 2) + at(i / 2, j1) + at(i1, j1));
    }
  return state;
}

// The middle below the corners at the static equilibrium, each found from the coarser one: material, masses
// and pins mean the same cloth on every grid.
TEST(Sag, OfSceneTwoIsTheSameWithin3PercentFrom17To129) {
  std::vector<double> sags_m;
  std::optional<Model> coarse;
  Equilibrium rest;
  for (const std::uint32_t n : {17u, 33u, 65u, 129u}) {
    Scene scene = load_scene(WEFT_SOURCE_DIR "/assets/scenes/2-four-corners.toml").scene;
    scene.cloth.resolution = n;
    scene.cloth.imperfection_m = 0.0;  // where it folds shall not depend on the grid's sampling of it
    Model model = build_model(scene);
    rest = find_equilibrium(model, coarse ? refined(*coarse, rest.position, model) : start_state(model), {});
    ASSERT_TRUE(rest.found()) << n << ": " << rest.reason;
    sags_m.push_back(rest.position[0].y - rest.position[model.grid.index(n / 2, n / 2)].y);
    std::printf("  %u: %.2f mm\n", n, 1e3 * sags_m.back());
    coarse = std::move(model);
  }
  const auto [least, most] = std::minmax_element(sags_m.begin(), sags_m.end());
  EXPECT_GT(*least, 0.05);
  EXPECT_LE(*most - *least, 0.03 * *least);
}

}  // namespace
}  // namespace weft::study
