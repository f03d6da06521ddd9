// Vertex normals of shapes whose normals are known.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "model/state_io.h"
#include "support/cloth.h"

namespace weft {
namespace {

using namespace testing_support;

std::vector<glm::dvec3> normals_of(const Model& model, const State& state) {
  HostBuffers<double> buffers;
  load_state(model, state, buffers);
  const KickDrift row;
  normals.mirror_f64({model, {}, row, 0}, buffers);
  std::vector<glm::dvec3> result;
  for (const auto& n : buffers[BufferId::normal]) result.emplace_back(n);
  return result;
}

// A vertical cloth faces +z, a horizontal one +y: the sides that the imperfection displaces to.
TEST(Normals, OfTheFlatStart) {
  Scene scene = bare_scene(5, 7, 0.1);
  for (const auto& [orientation, facing] : {std::pair{Orientation::vertical, glm::dvec3(0, 0, 1)},
                                            {Orientation::horizontal, glm::dvec3(0, 1, 0)}}) {
    scene.cloth.orientation = orientation;
    const Model model = build_model(scene);
    for (const glm::dvec3& n : normals_of(model, start_state(model)))
      EXPECT_LE(glm::distance(n, facing), 1e-12);
  }
}

/// Largest angle [rad] between the mesh's interior normals and the sphere's on a patch of a unit sphere.
double sphere_error_rad(std::uint32_t n) {
  const Model model = build_model(bare_scene(n, n, 1.0 / (n - 1)));
  State state = start_state(model);
  for (glm::dvec3& x : state.position) x = glm::normalize(glm::dvec3(x.x, x.y, 1.0));
  const std::vector<glm::dvec3> mesh = normals_of(model, state);
  double worst = 0.0;
  for (std::uint32_t j = 1; j + 1 < n; ++j)
    for (std::uint32_t i = 1; i + 1 < n; ++i) {
      const std::uint32_t p = model.grid.index(i, j);
      worst = std::max(worst, glm::length(glm::cross(mesh[p], state.position[p])));
    }
  return worst;
}

// Area-weighted averaging over six triangles is second order inside: a quarter of the error at twice n.
TEST(Normals, OfASpherePatchConvergeToItsRadii) {
  const double coarse = sphere_error_rad(17), fine = sphere_error_rad(33);
  EXPECT_LE(fine, 1e-3);
  EXPECT_GE(coarse / fine, 3.5);
}

TEST(Normals, AreUnitOrZero) {
  const Model model = build_model(bare_scene(6, 6, 0.1));
  State state = start_state(model);
  shake(state, 0.2, 0.0, 9);
  for (const glm::dvec3& n : normals_of(model, state)) EXPECT_NEAR(glm::length(n), 1.0, 1e-12);
  for (glm::dvec3& x : state.position) x = glm::dvec3(1, 2, 3);
  for (const glm::dvec3& n : normals_of(model, state)) EXPECT_EQ(n, glm::dvec3(0.0));
}

// The exported meshes' normals are the drawn ones.
TEST(Normals, AgreeWithTheExportedOnes) {
  const Model model = build_model(bare_scene(6, 4, 0.1));
  State state = start_state(model);
  shake(state, 0.05, 0.0, 4);
  const std::vector<glm::dvec3> drawn = normals_of(model, state),
                                exported = vertex_normals(model.grid, state);
  for (std::size_t p = 0; p < drawn.size(); ++p) EXPECT_LE(glm::distance(drawn[p], exported[p]), 1e-12);
}

}  // namespace
}  // namespace weft
