// Motion by keys: straight and steady between them, still before and after.
#include "model/motion.h"

#include <gtest/gtest.h>

#include "model/model.h"

namespace weft {
namespace {

const MotionKeys kThree{{1.0, {0, 0, 0}}, {2.0, {4, 0, 0}}, {4.0, {4, 2, 0}}};

TEST(Motion, IsHeldBeforeTheFirstKeyAndAfterTheLast) {
  for (const double t : {-1.0, 0.0, 1.0}) EXPECT_EQ(place_at(kThree, t), glm::dvec3(0, 0, 0)) << t;
  for (const double t : {4.0, 5.0, 1e9}) EXPECT_EQ(place_at(kThree, t), glm::dvec3(4, 2, 0)) << t;
  EXPECT_EQ(place_at({{3.0, {1, 2, 3}}}, 0.0), glm::dvec3(1, 2, 3)) << "a single key holds always";
}

TEST(Motion, IsStraightBetweenKeysAndMeetsThem) {
  EXPECT_EQ(place_at(kThree, 1.25), glm::dvec3(1, 0, 0));
  EXPECT_EQ(place_at(kThree, 2.0), glm::dvec3(4, 0, 0));
  EXPECT_EQ(place_at(kThree, 3.0), glm::dvec3(4, 1, 0));
}

TEST(Motion, KnowsItsFastestStretch) {
  EXPECT_EQ(fastest_m_s(kThree), 4.0);
  EXPECT_EQ(fastest_m_s({}), 0.0);
}

TEST(Motion, MovesASphereInPlaceOfItsVelocity) {
  SphereSection sphere{{9, 9, 9}, 0.1, {5, 5, 5}, 0.0, kThree};
  EXPECT_EQ(sphere_center_at(sphere, 3.0), glm::dvec3(4, 1, 0));
  sphere.keys.clear();
  EXPECT_EQ(sphere_center_at(sphere, 2.0), glm::dvec3(19, 19, 19));
}

}  // namespace
}  // namespace weft
