// State files: what is written reads back to the same bits, and appears whole or not at all.
#include "model/state_io.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <random>

#include "core/error.h"
#include "model/measures.h"

namespace weft {
namespace {

class StateFiles : public testing::Test {
 protected:
  StateFiles() {
    Scene scene;
    scene.cloth.resolution = 4;
    scene.cloth.height_m = 2.0 / 3.0;
    model_ = build_model(scene);
    state_ = start_state(model_);
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (auto* values : {&state_.position, &state_.velocity})
      for (glm::dvec3& v : *values) v += glm::dvec3(normal(random), 1e-9 * normal(random), normal(random));
    folder_ = std::filesystem::temp_directory_path() / ("weft-state-io-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~StateFiles() override { std::filesystem::remove_all(folder_); }

  Model model_;
  State state_;
  std::filesystem::path folder_;
};

TEST_F(StateFiles, CsvKeepsEveryBitOfADouble) {
  write_csv(folder_ / "a.csv", model_, state_, Digits::full);
  const State back = read_csv(folder_ / "a.csv", model_.grid);
  EXPECT_EQ(back.position, state_.position);
  EXPECT_EQ(back.velocity, state_.velocity);
}

TEST_F(StateFiles, CsvKeepsEveryBitOfAFloat) {
  for (auto* values : {&state_.position, &state_.velocity})
    for (glm::dvec3& v : *values) v = glm::dvec3(glm::vec3(v));
  write_csv(folder_ / "a.csv", model_, state_, Digits::single);
  const State back = read_csv(folder_ / "a.csv", model_.grid);
  for (std::size_t p = 0; p < back.position.size(); ++p) {
    EXPECT_EQ(glm::vec3(back.position[p]), glm::vec3(state_.position[p]));
    EXPECT_EQ(glm::vec3(back.velocity[p]), glm::vec3(state_.velocity[p]));
  }
}

TEST_F(StateFiles, CsvHasTheStatedHeaderAndOrder) {
  state_.position[1] = {0.5, -2.0, 1e-9};
  state_.velocity[1] = {0, 0, 3};
  write_csv(folder_ / "a.csv", model_, state_, Digits::single);
  const std::string text = read_file(folder_ / "a.csv");
  EXPECT_TRUE(text.starts_with("i,j,x,y,z,vx,vy,vz\n0,0,")) << text;
  EXPECT_NE(text.find("\n1,0,0.5,-2,1e-09,0,0,3\n"), std::string::npos) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 * 3);
}

TEST_F(StateFiles, CsvOfAnotherClothIsRefusedWithItsLine) {
  write_csv(folder_ / "a.csv", model_, state_, Digits::single);
  Grid other = model_.grid;
  other.nx = 3;
  EXPECT_THROW(read_csv(folder_ / "a.csv", other), Error);
  write_file(folder_ / "b.csv", "i,j,x,y,z,vx,vy,vz\n0,0,1,2,3,4,5\n");
  try {
    read_csv(folder_ / "b.csv", model_.grid);
    FAIL() << "accepted";
  } catch (const Error& refused) {
    EXPECT_NE(std::string(refused.what()).find("b.csv:2"), std::string::npos) << refused.what();
  }
}

TEST_F(StateFiles, AMissingFolderIsAnInputOutputError) {
  try {
    write_csv(folder_ / "absent" / "a.csv", model_, state_, Digits::full);
    FAIL() << "accepted";
  } catch (const Error& refused) {
    EXPECT_EQ(refused.code(), Exit::io);
  }
}

TEST_F(StateFiles, MeshesHaveEveryVertexAndTriangle) {
  write_obj(folder_ / "a.obj", model_, state_);
  write_ply(folder_ / "a.ply", model_, state_);
  const std::string obj = read_file(folder_ / "a.obj"), ply = read_file(folder_ / "a.ply");
  const auto lines = [](const std::string& text, const std::string& start) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("\n" + start, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(lines(obj, "v "), 12u);
  EXPECT_EQ(lines(obj, "vn "), 12u);
  EXPECT_EQ(lines(obj, "f "), 12u);  // 3 × 2 cells, two triangles each
  EXPECT_NE(obj.find("\nf 1/1/1 5/5/5 2/2/2\n"), std::string::npos);
  EXPECT_NE(ply.find("element vertex 12\n"), std::string::npos);
  EXPECT_NE(ply.find("element face 12\n"), std::string::npos);
  EXPECT_EQ(lines(ply, "3 "), 12u);
}

TEST_F(StateFiles, PointCacheHoldsEveryFrame) {
  PointCache cache(folder_ / "a.pc2", model_.grid);
  cache.add(state_);
  cache.add(start_state(model_));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.pc2"));
  cache.commit();
  const std::string bytes = read_file(folder_ / "a.pc2");
  ASSERT_EQ(bytes.size(), 32u + 2 * 12 * 12);
  EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
  const auto number = [&](std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  };
  EXPECT_EQ(number(12), 1u);
  EXPECT_EQ(number(16), 12u);
  EXPECT_EQ(number(28), 2u);
  float y;
  std::memcpy(&y, bytes.data() + 32 + 12 * 5 + 4, 4);
  EXPECT_EQ(y, static_cast<float>(state_.position[5].y));
}

}  // namespace
}  // namespace weft
