// Sliding on an incline: a slope and a tilted box let a cloth slip when tan θ > μ, and hold it otherwise.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/reader.h"
#include "support/run.h"

namespace weft {
namespace {

using testing_support::run_frames;

constexpr double kSlope = 0.4;  // tan θ

/// A cloth lying on the incline, 0.1 mm above it, which it falls on at once.
State lying_on_incline(const Model& model, const glm::dvec3& normal) {
  State state = start_state(model);
  const glm::dvec3 along = glm::normalize(glm::dvec3(normal.y, -normal.x, 0.0));
  for (glm::dvec3& x : state.position) x = x.x * along + glm::dvec3(0.0, 0.0, x.z) + 1e-4 * normal;
  return state;
}

/// How far [m] the middle has slid down in half a second.
double slid_down_m(const std::string& collider, double friction) {
  const Scene scene =
      parse_scene(
          "[cloth]\nresolution = 8\nwidth = 0.3\nheight = 0.3\norientation = "
          "\"horizontal\"\n[gravity]\n" +
              collider,
          "incline.toml",
          {.set = {fmt::format("floor.friction={}", friction),
                   collider.find("boxes") != std::string::npos ? fmt::format("boxes.0.friction={}", friction)
                                                               : "solver.precision=f32"}})
          .scene;
  const Model model = build_model(scene);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(kSlope, 1.0, 0.0));
  const State end = run_frames(model, lying_on_incline(model, normal), "leapfrog", "f32", 30, 1.0 / 60,
                               substeps_per_frame(model, find_solver("leapfrog")));
  double sum = 0.0;
  for (const glm::dvec3& x : end.position) sum += x.x / normal.y;
  return sum / double(end.position.size());
}

const std::string kTiltedFloor = fmt::format("[floor]\nnormal = [{}, 1, 0]\n", kSlope);
const std::string kTiltedBox = fmt::format(
    "[floor]\nheight = -5\n[[boxes]]\ncenter = [{}, {}, 0]\nsize = [4, 1, 2]\nrotation = [0, 0, {}]\n",
    -0.5 * std::sin(std::atan(kSlope)), -0.5 * std::cos(std::atan(kSlope)),
    -std::atan(kSlope) * 180.0 / std::numbers::pi);

class Incline : public testing::TestWithParam<std::string> {};

// s = ½·g·(sin θ − μ cos θ)·t² where tan θ > μ; the fall of 0.1 mm costs 1 %.
TEST_P(Incline, SlipsAsCoulombSays) {
  const double angle = std::atan(kSlope), friction = 0.2;
  const double expected_m = 0.5 * 9.81 * (std::sin(angle) - friction * std::cos(angle)) * 0.25;
  EXPECT_NEAR(slid_down_m(GetParam(), friction), expected_m, 0.03 * expected_m);
}

TEST_P(Incline, HoldsWhereFrictionIsMore) { EXPECT_LE(slid_down_m(GetParam(), 0.45), 1e-3); }

INSTANTIATE_TEST_SUITE_P(FloorAndBox, Incline, testing::Values(kTiltedFloor, kTiltedBox),
                         [](const auto& p) { return p.index == 0 ? "Floor" : "Box"; });

/// A wall of 0.1 m that flies at a free cloth at `speed_m_s`, as a box or as a mesh of twelve triangles: how
/// far [m] the rearmost particle ends in front of the wall's face, after two frames.
double ahead_of_wall_m(const std::string& wall, double speed_m_s) {
  const Scene scene =
      parse_scene(fmt::format("[cloth]\nresolution = 8\ncenter = [0.03, 0.02, 1]\n{}velocity = [0, 0, {}]\n"
                              "[solver]\nsubsteps = 60\n",
                              wall, speed_m_s),
                  "wall.toml")
          .scene;
  const Model model = build_model(scene);
  const State end = run_frames(model, start_state(model), "leapfrog", "f32", 2, 1.0 / 60, 60);
  double least_m = 1e300;
  for (const glm::dvec3& x : end.position) least_m = std::min(least_m, x.z - speed_m_s * 2.0 / 60.0 - 0.05);
  return least_m;
}

// At 1000 m/s the wall moves 28 cm in a substep, three times its thickness: nothing is left behind it. A
// float's last bit at 33 m is 4 µm.
TEST(Walls, NothingPassesThroughThemHoweverFast) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("weft-wall-" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "wall.obj")
      << "v -1.5 -1.5 -.05\nv 1.5 -1.5 -.05\nv -1.5 1.5 -.05\nv 1.5 1.5 -.05\nv -1.5 -1.5 .05\nv 1.5 -1.5 "
         ".05\n"
         "v -1.5 1.5 .05\nv 1.5 1.5 .05\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const std::string box = "[[boxes]]\ncenter = [0, 0, 0]\nsize = [3, 3, 0.1]\n";
  const std::string mesh = fmt::format("[[meshes]]\ncenter = [0, 0, 0]\nresolution = 96\nfile = \"{}\"\n",
                                       (folder / "wall.obj").string());
  for (const double speed_m_s : {100.0, 1000.0}) {
    EXPECT_GE(ahead_of_wall_m(box, speed_m_s), -2e-5) << speed_m_s;
    EXPECT_GE(ahead_of_wall_m(mesh, speed_m_s), -2e-5) << speed_m_s;
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace weft
