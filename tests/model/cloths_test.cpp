// The model of several cloths: all of each as if it were alone, nothing between them; files and carrying
// over.
#include "support/cloths.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/file.h"
#include "model/carry.h"
#include "model/measures.h"
#include "model/springs.h"
#include "model/state_io.h"

namespace weft {
namespace {

using testing_support::alone;
using testing_support::part_of;

/// Two cloths of 7 x 5 particles; the second lies, and is held by a corner.
Scene pair_of_cloths() {
  Scene scene;
  scene.cloth = {.width_m = 1.2, .height_m = 0.8, .resolution = 7, .imperfection_m = 0.01};
  scene.cloths = {{.center_m = {0.0, 2.0, 0.0}, .orientation = Orientation::horizontal}};
  scene.material.bend_n_m = 1e-4;
  scene.pins = {{.at = {0.0, 0.0}}, {.at = {1.0, 1.0}, .cloth = 1}};
  return scene;
}

TEST(ModelCloths, AreEachTheModelOfOne) {
  const Scene scene = pair_of_cloths();
  const Model both = build_model(scene);
  ASSERT_EQ(both.grid.count(), 2u * 7u * 5u);
  const State start = start_state(both);
  std::uint64_t springs = 0;
  StepBound largest;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const Model one = build_model(alone(scene, k));
    EXPECT_EQ(part_of(both.grid, start, k).position, start_state(one).position);
    for (std::uint32_t p = 0; p < one.grid.count(); ++p)
      EXPECT_EQ(both.relative_inverse_mass[k * one.grid.count() + p], one.relative_inverse_mass[p]);
    springs += one.spring_count;
    largest.lambda_1_s2 = std::max(largest.lambda_1_s2, one.bound.lambda_1_s2);
    largest.gamma_1_s = std::max(largest.gamma_1_s, one.bound.gamma_1_s);
  }
  EXPECT_EQ(both.spring_count, springs);
  EXPECT_EQ(both.bound.lambda_1_s2, largest.lambda_1_s2);
  EXPECT_EQ(both.bound.gamma_1_s, largest.gamma_1_s);
}

// At rest in both, so that the energy of bending and springs is that of the imperfections alone.
TEST(ModelCloths, HaveTheSumOfTheirEnergies) {
  const Scene scene = pair_of_cloths();
  const Model both = build_model(scene);
  double elastic_j = 0.0, bending_j = 0.0;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const Model one = build_model(alone(scene, k));
    elastic_j += energy(one, start_state(one)).elastic_j;
    bending_j += energy(one, start_state(one)).bending_j;
  }
  const Energy all = energy(both, start_state(both));
  EXPECT_GT(bending_j, 0.0);
  EXPECT_NEAR(all.elastic_j, elastic_j, 1e-12 * elastic_j);
  EXPECT_NEAR(all.bending_j, bending_j, 1e-12 * bending_j);
}

// Affine fields carry over to any grid exactly; each cloth has its own here.
TEST(ModelCloths, CarryOverClothByCloth) {
  Scene scene = pair_of_cloths();
  const Model from = build_model(scene);
  State state = start_state(from);
  const std::size_t half = state.position.size() / 2;
  for (std::size_t p = 0; p < state.position.size(); ++p) state.position[p].z += p < half ? 1.0 : -3.0;
  scene.cloth.resolution = 13;
  scene.cloths.push_back({.center_m = {0.0, 5.0, 0.0}});
  const Model to = build_model(scene);
  const State carried = carry_state(from, state, to), start = start_state(to);
  for (std::uint32_t p = 0; p < to.grid.count(); ++p) {
    const std::uint32_t cloth = p / (to.grid.nx * to.grid.ny);
    const double moved_m = cloth == 0 ? 1.0 : cloth == 1 ? -3.0 : 0.0;
    EXPECT_NEAR(carried.position[p].z, start.position[p].z + moved_m, 1e-12) << p;
  }
}

TEST(ModelCloths, AreWrittenAndReadBackWhole) {
  const Model both = build_model(pair_of_cloths());
  const State start = start_state(both);
  const std::filesystem::path folder = std::filesystem::path(WEFT_BINARY_DIR) / "test-cloths";
  std::filesystem::create_directories(folder);
  write_csv(folder / "both.csv", both, start, Digits::full);
  EXPECT_EQ(read_csv(folder / "both.csv", both.grid).position, start.position);
  write_obj(folder / "both.obj", both, start);
  const std::string text = read_file(folder / "both.obj");
  std::size_t faces = 0, joined = 0;
  for (std::size_t at = text.find("\nf "); at != std::string::npos; at = text.find("\nf ", at + 1)) {
    unsigned a = 0, b = 0, c = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + at, "\nf %u/%*u/%*u %u/%*u/%*u %u/", &a, &b, &c), 3);
    ++faces;
    joined += (a <= 35) == (b <= 35) && (a <= 35) == (c <= 35) ? 0u : 1u;
  }
  EXPECT_EQ(faces, 2u * 2u * 6u * 4u);  // two triangles in each of 6 x 4 cells, of each cloth
  EXPECT_EQ(joined, 0u);
}

}  // namespace
}  // namespace weft
