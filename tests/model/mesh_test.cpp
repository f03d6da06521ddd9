// Meshes as distance grids: right to a fraction of a cell, kept between runs, and refused with a reason.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <numbers>

#include "core/error.h"
#include "model/distance_grid.h"
#include "model/model.h"
#include "scene/reader.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

/// A folder that also holds the cache while it lives.
class MeshTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("weft-mesh-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    if (const char* cache = std::getenv("XDG_CACHE_HOME")) cache_before_ = cache;
    setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
  }
  void TearDown() override {
    setenv("XDG_CACHE_HOME", cache_before_.c_str(), 1);
    fs::remove_all(folder_);
  }
  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string refusal(const std::string& text, Exit expected) {
    try {
      read_mesh(write("bad.obj", text), 1.0);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), expected) << e.what();
      return e.what();
    }
    return "not refused";
  }

  fs::path folder_;
  std::string cache_before_;
};

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
const std::string kCube = kCorners + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// Outside: distance to the unit cube; inside: minus the distance to its nearest face.
double cube_distance(const glm::dvec3& p) {
  const glm::dvec3 q = glm::abs(p - 0.5) - 0.5;
  return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

TEST_F(MeshTest, DistancesOfACubeAreThose) {
  const DistanceGrid grid = make_distance_grid(read_mesh(write("cube.obj", kCube), 1.0), 20, 0.1);
  double worst_m = 0.0;
  std::size_t k = 0;
  for (std::uint32_t z = 0; z < grid.samples.z; ++z)
    for (std::uint32_t y = 0; y < grid.samples.y; ++y)
      for (std::uint32_t x = 0; x < grid.samples.x; ++x, ++k) {
        const glm::dvec3 at = grid.low_m + grid.cell_m * glm::dvec3(x, y, z);
        worst_m = std::max(worst_m, std::abs(double(grid.distance[k]) - cube_distance(at)));
      }
  EXPECT_LE(worst_m, 1e-6);  // what rounding to float leaves
  EXPECT_NEAR(distance_at(grid, {0.5, 0.5, 1.02}), 0.02, 1e-6);
}

// A mesh whose triangles all run the other way encloses the same volume.
TEST_F(MeshTest, TurnedInsideOutIsTheSame) {
  const std::string turned = kCorners + "f 2 4 3 1\nf 7 8 6 5\nf 5 6 2 1\nf 4 8 7 3\nf 3 7 5 1\nf 6 8 4 2\n";
  const DistanceGrid grid = make_distance_grid(read_mesh(write("turned.obj", turned), 1.0), 8, 0.0);
  EXPECT_NEAR(distance_at(grid, {0.5, 0.5, 0.5}), -0.5, 1e-6);
}

TEST_F(MeshTest, BadMeshesAreRefusedWithTheReason) {
  EXPECT_NE(refusal(kCorners + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n", Exit::usage)
                .find("not closed"),
            std::string::npos);
  EXPECT_NE(
      refusal(kCorners + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n", Exit::usage)
          .find("disagree"),
      std::string::npos);
  EXPECT_NE(refusal("nothing at all\n", Exit::usage).find("triangles"), std::string::npos);
  EXPECT_NE(refusal("nothing at all\n", Exit::usage).find("(export"), std::string::npos);
  EXPECT_NE(refusal("v 0 0 0\nv 1e9 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n", Exit::usage)
                .find("meshes.scale"),
            std::string::npos);
  for (const char* vertex : {"v 0 0 1x", "v nan 0 0", "v 0 1e999 0", "v 0 1", "v inf 0 0"}) {
    const std::string reason = refusal(kCorners + vertex + "\n", Exit::usage);
    EXPECT_NE(reason.find("three finite numbers"), std::string::npos) << reason;
    EXPECT_NE(reason.find(vertex), std::string::npos) << reason;
  }
  try {
    read_mesh(folder_ / "missing.obj", 1.0);
    FAIL() << "a missing file is refused";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), Exit::io);
  }
}

// Of several meshes a refusal names the entry that is meant: its line, or the --set that gave it.
TEST_F(MeshTest, RefusalsNameTheEntry) {
  write("cube.obj", kCube);
  write("open.obj", kCorners + "f 1 2 3\nf 2 3 4\n");
  const std::string scene = (folder_ / "scene.toml").string();
  const std::string first = "[cloth]\nresolution = 4\n[[meshes]]\ncenter = [0, -9, 0]\nfile = \"cube.obj\"\n";
  const auto reason = [&](const std::string& file, const SceneOverrides& overrides, Exit expected) {
    const std::string text = first + "[[meshes]]\ncenter = [0, 9, 0]\nfile = \"" + file + "\"\n";
    try {
      build_model(parse_scene(text, scene, overrides).scene);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), expected) << e.what();
      return std::string(e.what());
    }
    return std::string("not refused");
  };
  const std::string few = reason("open.obj", {}, Exit::usage);
  EXPECT_TRUE(few.starts_with(scene + ":8: meshes.1.file is \"open.obj\"; ")) << few;
  EXPECT_NE(few.find("it has 2 triangles"), std::string::npos) << few;
  const std::string missing = reason("gone.obj", {}, Exit::io);
  EXPECT_TRUE(missing.starts_with(scene + ":8: meshes.1.file is \"gone.obj\"; ")) << missing;
  const std::string set = reason("cube.obj", {{"meshes.0.file=open.obj"}}, Exit::usage);
  EXPECT_TRUE(set.starts_with("--set meshes.0.file=open.obj: meshes.0.file is \"open.obj\"; ")) << set;
}

// The second time it comes from the cache; a cache that is damaged is made anew.
TEST_F(MeshTest, IsKeptBetweenRuns) {
  write("cube.obj", kCube);
  Scene scene;
  scene.source = (folder_ / "scene.toml").string();
  MeshSection& mesh = scene.meshes.emplace_back();
  mesh.file = "cube.obj";
  mesh.resolution = 8;
  const auto first = load_distance_grid(scene, 0, 0.0);
  ASSERT_EQ(std::distance(fs::directory_iterator(folder_ / "weft"), {}), 1);
  const fs::path kept = fs::directory_iterator(folder_ / "weft")->path();
  EXPECT_EQ(load_distance_grid(scene, 0, 0.0)->distance, first->distance);
  fs::resize_file(kept, fs::file_size(kept) - 5);
  EXPECT_EQ(load_distance_grid(scene, 0, 0.0)->distance, first->distance);
  mesh.scale = 2.0;
  EXPECT_NEAR(load_distance_grid(scene, 0, 0.0)->cell_m, 2.0 * first->cell_m, 1e-12);
}

}  // namespace
}  // namespace weft
