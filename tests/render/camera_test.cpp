// The camera's matrix against its definition, and that the default view holds every scene.
#include "render/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "render/sheet.h"
#include "scene/reader.h"
#include "sim/simulation.h"
#include "solvers/solver.h"

namespace weft::test {
namespace {

glm::dvec3 ndc(const Camera& camera, double aspect, const glm::dvec3& p) {
  const glm::vec4 c = camera.clip(aspect) * glm::vec4(p, 1.0);
  return glm::dvec3(c) / double(c.w);
}

TEST(Camera, AxesAreOrthonormalAndRightHanded) {
  Camera camera;
  camera.yaw_rad = 0.7;
  camera.pitch_rad = -0.4;
  EXPECT_NEAR(glm::dot(camera.right(), camera.up()), 0.0, 1e-12);
  EXPECT_NEAR(glm::dot(camera.right(), camera.forward()), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(glm::cross(camera.right(), camera.up()), -camera.forward()), 0.0, 1e-12);
  EXPECT_GT(camera.up().y, 0.0);
}

TEST(Camera, ClipSpaceIsVulkansWithReversedDepth) {
  Camera camera;
  camera.target_m = {1.0, 2.0, 3.0};
  camera.yaw_rad = 0.5;
  camera.pitch_rad = 0.3;
  const double aspect = 1.5;
  EXPECT_NEAR(glm::length(glm::dvec2(ndc(camera, aspect, camera.target_m))), 0.0, 1e-6);
  const glm::dvec3 at_near = camera.eye_m() + camera.near_m() * camera.forward();
  EXPECT_NEAR(ndc(camera, aspect, at_near).z, 1.0, 1e-4);
  EXPECT_NEAR(ndc(camera, aspect, camera.eye_m() + 1e4 * camera.forward()).z, 0.0, 1e-4);
  // The picture's top edge is y = −1, half the field of view above the axis; its right edge x = +1.
  const double rise = camera.distance_m * std::tan(0.5 * camera.fov_y_rad);
  EXPECT_NEAR(ndc(camera, aspect, camera.target_m + rise * camera.up()).y, -1.0, 1e-5);
  EXPECT_NEAR(ndc(camera, aspect, camera.target_m + rise * aspect * camera.right()).x, 1.0, 1e-5);
}

TEST(Camera, DefaultViewHoldsEverySceneWithoutWaste) {
  for (const AssetInfo& info : numbered_scenes())
    for (const double aspect : {16.0 / 9.0, 1.0, 0.5}) {
      const Model model = build_model(load_scene(info.file).scene);
      const Camera camera = default_camera(model, aspect);
      const Bounds bounds = scene_bounds(model);
      double reach = 0.0;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p{(corner & 1) != 0 ? bounds.high.x : bounds.low.x,
                           (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
                           (corner & 4) != 0 ? bounds.high.z : bounds.low.z};
        const glm::dvec3 place = ndc(camera, aspect, p);
        reach = std::max({reach, std::abs(place.x), std::abs(place.y)});
        EXPECT_GT(place.z, 0.0);
      }
      EXPECT_LE(reach, 1.0) << info.name << " leaves the picture";
      EXPECT_GE(reach, 0.85) << info.name << " is needlessly far away";
    }
}

TEST(Camera, DefaultViewHoldsTheClothWhereverItGoes) {
  constexpr double kAspect = 16.0 / 9.0;
  for (const AssetInfo& info : numbered_scenes()) {
    const Model model = build_model(load_scene(info.file).scene);
    const Camera camera = default_camera(model, kAspect);
    const auto simulation = make_cpu_simulation(model, find_solver(model.scene.solver.name), "f32");
    for (int frame = 1; frame <= 60; ++frame) {
      simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
      if (frame % 15 != 0) continue;
      double reach = 0.0;
      for (const glm::dvec3& p : simulation->read().position) {
        const glm::dvec3 place = ndc(camera, kAspect, p);
        reach = std::max({reach, std::abs(place.x), std::abs(place.y)});
      }
      EXPECT_LE(reach, 1.0) << info.name << " leaves the picture after " << frame << " frames";
    }
  }
}

// On a floor that leans it slides on and on: as long as the film is, and no farther away than that asks for.
TEST(Camera, DefaultViewFollowsAClothDownASlope) {
  constexpr double kAspect = 16.0 / 9.0;
  const Model model = build_model(load_scene(find_scene("slope")).scene);
  const auto simulation = make_cpu_simulation(model, find_solver(model.scene.solver.name), "f32");
  double reach_before = 0.0;
  for (int frame = 1; frame <= 180; ++frame) {
    simulation->advance(model.scene.solver.frame_s, simulation->plan().substeps);
    if (frame % 45 != 0) continue;
    const Camera camera = default_camera(model, kAspect, frame / 60.0);
    double reach = 0.0;
    for (const glm::dvec3& p : simulation->read().position) {
      const glm::dvec3 place = ndc(camera, kAspect, p);
      reach = std::max({reach, std::abs(place.x), std::abs(place.y)});
    }
    EXPECT_LE(reach, 1.0) << "leaves the picture after " << frame << " frames";
    reach_before = std::max(reach_before, reach);
  }
  EXPECT_GE(reach_before, 0.6) << "is needlessly far away";
}

TEST(Camera, BoundsKnowWhereAClothWillHang) {
  Scene scene;
  scene.cloth.center_m = {0.0, 1.0, 0.0};
  scene.cloth.orientation = Orientation::horizontal;
  scene.pins = {PinSection{{0.5, 0.5}, 0.05}};
  scene.cloth.resolution = 17;
  // Threads from the centre to the corners are √½ m long and hang straight down.
  EXPECT_NEAR(scene_bounds(build_model(scene)).low.y, 1.0 - std::sqrt(0.5), 1e-9);
  scene.pins.clear();
  scene.gravity = GravitySection{};
  scene.floor = FloorSection{0.25, 0.0};
  EXPECT_NEAR(scene_bounds(build_model(scene)).low.y, 0.25, 1e-9);
}

}  // namespace
}  // namespace weft::test
