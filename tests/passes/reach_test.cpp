// What does not come near a body is not touched by one, whatever both do in the substep; and near is not far.
#include "passes/reach.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "passes/solid.h"
#include "scene/reader.h"

namespace weft {
namespace {

std::string vector_text(const glm::dvec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// A box or a capsule of any size, that goes anywhere and turns by up to 3500 degrees a second.
Model random_body(std::mt19937& random, double turn_deg) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto around = [&](double scale) {
    const double x = unit(random), y = unit(random), z = unit(random);
    return scale * glm::dvec3(x, y, z);
  };
  const glm::dvec3 size = glm::abs(around(0.5)) + 0.01, start = around(2.0), end = start + around(0.3);
  const glm::dvec3 angles = around(180.0), turned = angles + around(turn_deg);
  const std::string keys = fmt::format(
      "keys = [{{ time = 0, center = {}, rotation = {} }}, {{ time = 0.01, center = {}, rotation = "
      "{} }}]\n",
      vector_text(start), vector_text(angles), vector_text(end), vector_text(turned));
  const bool box = unit(random) < 0.0;
  const std::string body =
      box ? fmt::format("[[boxes]]\nsize = {}\n", vector_text(size))
          : fmt::format("[[capsules]]\na = [0, 0, 0]\nb = {}\nradius = {}\n", vector_text(size), size.x);
  return build_model(parse_scene("[cloth]\nresolution = 4\n" + body + keys, "body.toml").scene);
}

template <class T>
struct Tried {
  int far = 0, near = 0, touched = 0;
};

/// Paths of every length that does not count as near, that end in and about the box.
template <class T>
void try_paths(const Model& model, double drift_s, std::mt19937& random, Tried<T>& tried) {
  const KickDrift row{.kick_s = drift_s, .drift_s = drift_s, .drift_time_s = 0.003};
  const ReachRow<T> reach = reach_row<T>(model, row);
  const SubstepRow<T> bodies = substep_row<T>(model, row);
  std::uniform_real_distribution<T> share(T(-0.2), T(1.2)), way(T(-1), T(1));
  for (int trial = 0; trial < 400; ++trial) {
    glm::vec<3, T> x0, x1;
    for (int axis = 0; axis < 3; ++axis) {
      x1[axis] = reach.low[axis] + share(random) * (reach.high[axis] - reach.low[axis]);
      x0[axis] = x1[axis] - T(0.999) * way(random) * reach.leap;
    }
    const bool near = glm::all(glm::greaterThan(x1, reach.low)) && glm::all(glm::lessThan(x1, reach.high));
    const glm::vec<3, T> free_x = x1, free_v = (x1 - x0) / static_cast<T>(drift_s);
    glm::vec<3, T> v = free_v;
    solid_touch(bodies.solids[0], x0, x1, v);
    const bool same = x1 == free_x && v == free_v;
    ++(near ? tried.near : tried.far);
    tried.touched += same ? 0 : 1;
    ASSERT_TRUE(near || same) << "drift " << drift_s << ", trial " << trial;
  }
}

template <class T>
void expect_only_near_is_touched() {
  std::mt19937 random(6);
  Tried<T> tried;
  for (int body = 0; body < 60; ++body)
    for (const double turn_deg : {0.0, 3.0, 35.0}) {
      const Model model = random_body(random, turn_deg);
      for (const double drift_s : {2e-5, 2e-4, 2e-3}) try_paths<T>(model, drift_s, random, tried);
    }
  EXPECT_GT(tried.far, 50000);
  EXPECT_GT(tried.near, 30000);
  EXPECT_GT(tried.touched, 1000);
}

TEST(Reach, OnlyWhatIsNearIsTouchedInFloat) { expect_only_near_is_touched<float>(); }
TEST(Reach, OnlyWhatIsNearIsTouchedInDouble) { expect_only_near_is_touched<double>(); }

// A box at rest: beside its own extent and half the cloth's thickness no more than what 64 m/s go in a drift
// (along each axis, hence √3 times that), and less than a millimetre for rounding.
TEST(Reach, IsTightAroundABodyAtRest) {
  const Model model = build_model(
      parse_scene("[cloth]\nresolution = 4\n[[boxes]]\ncenter = [3, 1, 0]\nsize = [0.4, 0.2, 0.6]\n",
                  "rest.toml")
          .scene);
  const ReachRow<double> reach = reach_row_exact(model, {.kick_s = 1e-4, .drift_s = 1e-4});
  const glm::dvec3 half = glm::dvec3(0.2, 0.1, 0.3) + model.half_thickness_m + std::sqrt(3.0) * 6.4e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const double centre = axis == 0 ? 3.0 : axis == 1 ? 1.0 : 0.0;
    EXPECT_NEAR(reach.low[axis], centre - half[axis], 1e-3);
    EXPECT_NEAR(reach.high[axis], centre + half[axis], 1e-3);
  }
  EXPECT_DOUBLE_EQ(reach.leap, 6.4e-3);
}

TEST(Reach, IsNothingWithoutADriftAndAbsentWithoutABody) {
  const Model bare = build_model(parse_scene("[cloth]\nresolution = 4\n[floor]\n", "bare.toml").scene);
  EXPECT_FALSE(has_reach(bare));
  const Model leaning = build_model(parse_scene("[cloth]\nresolution = 4\n[floor]\nnormal = [0.3, 1, "
                                                "0]\n[[boxes]]\ncenter = [0, 1, 0]\nsize = [1, 1, 1]\n",
                                                "leaning.toml")
                                        .scene);
  EXPECT_FALSE(has_reach(leaning)) << "contact holds the floor that leans, wherever the box is";
  std::mt19937 random(1);
  const ReachRow<double> reach = reach_row_exact(random_body(random, 0.0), {.kick_s = 1e-4});
  EXPECT_GT(reach.low.x, reach.high.x);
}

}  // namespace
}  // namespace weft
