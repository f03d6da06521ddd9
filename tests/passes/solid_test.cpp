// Contact with capsules and boxes: nothing passes through in one step however fast, what they carry is
// carried along, and a capsule without length is a sphere.
#include "passes/solid.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

namespace weft {
namespace {

using glm::dvec3;

/// At the origin, unturned, at rest.
SolidRow<double> still_solid(const dvec3& half, double reach, double friction = 0.0) {
  SolidRow<double> row{};
  row.half = half;
  for (int k = 0; k < 3; ++k) row.axes[k][k] = row.start_axes[k][k] = 1.0;
  row.reach = reach;
  row.deep = 0.01 * (reach + std::min({half.x, half.y, half.z}));
  row.friction = friction;
  return row;
}

dvec3 random_point(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return {x, y, z};
}

/// The least distance along a path, by many samples.
double least_distance(const SolidRow<double>& solid, const dvec3& from, const dvec3& to) {
  double least = 1e300;
  for (int k = 0; k <= 1000; ++k)
    least = std::min(least, near_solid(solid, from + (k / 1000.0) * (to - from)).distance);
  return least;
}

// The gradient is a unit vector, and a step against it by the distance ends on the surface.
TEST(Solid, DistanceLeadsToTheSurface) {
  std::mt19937_64 random(3);
  for (const auto& solid : {still_solid({0.3, 0.1, 0.5}, 0.0), still_solid({0.3, 0.1, 0.5}, 0.05),
                            still_solid({0.0, 0.6, 0.0}, 0.1)})
    for (int trial = 0; trial < 3000; ++trial) {
      const dvec3 p = 0.5 * random_point(random);
      const SolidNear<double> near = near_solid(solid, p);
      EXPECT_NEAR(glm::length(near.normal), 1.0, 1e-12);
      EXPECT_NEAR(near_solid(solid, p - near.distance * near.normal).distance, 0.0, 1e-12);
    }
}

// Random moves from outside, from 1 mm to 1 km: the end is never inside, and a path that goes deeper than the
// chords that are let pass ends where it entered.
TEST(Solid, IsNeverEnteredNorCrossed) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> decade(-3.0, 3.0);
  int stopped = 0;
  for (const auto& solid : {still_solid({0.3, 0.02, 0.5}, 0.0), still_solid({0.2, 0.2, 0.2}, 0.03),
                            still_solid({0.0, 0.6, 0.0}, 0.1)})
    for (int trial = 0; trial < 1000; ++trial) {
      dvec3 x0 = random_point(random);
      x0 *= 1.0 + std::pow(10.0, decade(random)) / glm::length(x0);
      if (near_solid(solid, x0).distance <= 0.0) continue;
      const dvec3 aim = 0.3 * random_point(random) - x0;
      const dvec3 end = x0 + aim * (1.0 + std::pow(10.0, decade(random)) / glm::length(aim));
      dvec3 x1 = end, v = end - x0;
      solid_touch(solid, x0, x1, v);
      EXPECT_GE(near_solid(solid, x1).distance, -1e-9);
      if (least_distance(solid, x0, end) > -solid.deep) continue;
      ++stopped;
      EXPECT_GE(least_distance(solid, x0, x1), -1.3 * solid.deep) << "it came out behind";
    }
  EXPECT_GT(stopped, 700);
}

// What is pulled into a face while it runs along it, frictionless, runs on as fast as its velocity says.
// Stopped where it entered, it would stay there while the pull made it faster and faster.
TEST(Solid, LetsSlideWhatIsPulledIn) {
  const SolidRow<double> box = still_solid({0.5, 0.2, 0.5}, 0.0);
  dvec3 x(-0.4, 0.2, 0.0);
  for (int step = 0; step < 20; ++step) {
    const dvec3 before = x;
    dvec3 v(0.02, -2.0 * box.deep, 0.01);  // a drift of a unit of time
    x += v;
    solid_touch(box, before, x, v);
    EXPECT_LT(glm::distance(x, before + dvec3(0.02, 0.0, 0.01)), 1e-12);
    EXPECT_LT(glm::distance(v, dvec3(0.02, 0.0, 0.01)), 1e-12);
  }
}

// A rotating bar sweeps a particle at rest that it passes over within one drift.
TEST(Solid, SweepsWhatItTurnsOver) {
  SolidRow<double> bar = still_solid({1.0, 0.02, 0.02}, 0.0);
  const double angle = 0.5;  // [rad], about z
  bar.axes[0] = {std::cos(angle), std::sin(angle), 0.0};
  bar.axes[1] = {-std::sin(angle), std::cos(angle), 0.0};
  bar.spin = {0.0, 0.0, angle / 1e-3};
  const dvec3 start(0.6, 0.1, 0.0);  // the bar lies below it before, above it after
  dvec3 x1 = start, v(0.0);
  solid_touch(bar, start, x1, v);
  const dvec3 own = in_frame(bar.axes, x1);
  EXPECT_NEAR(own.y, 0.02, 1e-9) << "on the side it was on";
  EXPECT_GT(v.y, 0.5 * 0.6 * angle / 1e-3);
}

// Coulomb: what slides on a belt is carried along with it, and no faster.
TEST(Solid, FrictionCarriesAlong) {
  SolidRow<double> belt = still_solid({1.0, 0.1, 1.0}, 0.0, 0.5);
  belt.velocity = {2.0, 0.0, 0.0};
  dvec3 x1(0.0, 0.0999, 0.0), v(0.0, -1.0, 0.0);
  solid_touch(belt, dvec3(0.0, 0.1001, 0.0), x1, v);
  EXPECT_NEAR(v.x, 0.5, 1e-12);  // μ times the approach that was taken
  EXPECT_NEAR(v.y, 0.0, 1e-12);
}

// A capsule whose ends coincide does what a sphere does.
TEST(Solid, ACapsuleWithoutLengthIsASphere) {
  std::mt19937_64 random(8);
  const SolidRow<double> capsule = still_solid({0.0, 0.0, 0.0}, 1.0, 0.3);
  const SphereRow<double> sphere{dvec3(0.0), dvec3(0.0), dvec3(0.0), 1.0, 0.3};
  for (int trial = 0; trial < 2000; ++trial) {
    dvec3 x0 = random_point(random);
    x0 *= 1.0 + 1.0 / glm::length(x0);
    const dvec3 end = 0.5 * random_point(random);
    if (glm::length(end) > 0.95) continue;
    dvec3 a = end, va = end - x0, b = end, vb = va;
    solid_touch(capsule, x0, a, va);
    sphere_contact(sphere, x0, b, vb);
    EXPECT_LE(glm::distance(a, b), 0.1)
        << "an entry is found to a 400th of the radius, and its normal turns the rest of the way";
    EXPECT_GE(glm::dot(va, a), -1e-9);
  }
}

}  // namespace
}  // namespace weft
