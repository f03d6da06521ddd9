// Contact: nothing passes through a sphere in one step however fast, friction is Coulomb's, floors hold.
#include "passes/contact.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

namespace weft {
namespace {

using glm::dvec3;

SphereRow<double> sphere(double friction, const dvec3& travel = dvec3(0.0),
                         const dvec3& velocity = dvec3(0.0)) {
  return {dvec3(0.0), travel, velocity, 1.0, friction};
}

/// Where a straight move first comes within `radius` of the origin; false when it never does.
bool entry(const dvec3& from, const dvec3& to, double radius, dvec3& place) {
  const dvec3 d = to - from;
  const double a = glm::dot(d, d), b = glm::dot(from, d), c = glm::dot(from, from) - radius * radius;
  if (b * b - a * c < 0) return false;
  const double t = (-b - std::sqrt(b * b - a * c)) / a;
  place = from + t * d;
  return t >= 0 && t <= 1;
}

// Head-on, off-centre and grazing, at steps of 10 cm to 1 km across a sphere of radius 1 m: what goes through
// it ends on the tangent plane where it entered, moved along the normal only; what ends just inside may be
// pushed out where it is.
TEST(Sphere, TurnsEveryFastParticleAsideWhereItEntered) {
  for (const double step_m : {0.1, 1.0, 10.0, 100.0, 1000.0}) {
    for (const double offset : {0.0, 0.3, 0.7, 0.95, 0.985}) {
      for (const double ahead : {1.001, 1.05, 1.5, 3.0}) {
        const dvec3 x0(-ahead, offset, 0.0);
        if (glm::length(x0) < 1.0) continue;
        const dvec3 end = x0 + dvec3(step_m, 0, 0);
        dvec3 x1 = end, v(step_m * 1000, 0, 0), n;
        const bool inside = glm::length(x1) < 1.0;
        const bool crosses = entry(x0, x1, 1.0, n);
        sphere_contact(sphere(0.0), x0, x1, v);
        if (!crosses) continue;
        EXPECT_GE(glm::length(x1), 1.0 - 1e-9) << step_m << " " << offset << " " << ahead;
        if (!inside) {
          const dvec3 expected = end - glm::dot(end - n, n) * n;
          EXPECT_LE(glm::distance(x1, expected), 1e-9 * step_m) << step_m << " " << offset << " " << ahead;
        }
        EXPECT_GE(glm::dot(v, x1), -1e-9 * step_m * 1000) << "still going in";
      }
    }
  }
}

// Random moves from outside: the end is never inside, and a path deeper than 1 % never comes out behind the
// tangent plane where it entered, which the whole sphere lies behind.
TEST(Sphere, IsNeverEnteredNorCrossed) {
  std::mt19937_64 random(42);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> decade(-3.0, 3.0);
  int hits = 0;
  for (int trial = 0; trial < 200000; ++trial) {
    dvec3 x0(normal(random), normal(random), normal(random));
    x0 *= (1.0 + std::pow(10.0, decade(random))) / glm::length(x0);
    const dvec3 aim = 0.8 * dvec3(normal(random), normal(random), normal(random)) - x0;
    const dvec3 target = x0 + aim * std::pow(10.0, decade(random));
    dvec3 x1 = target, v = 1000.0 * (target - x0), deep;
    const bool through = entry(x0, target, 0.98, deep);
    sphere_contact(sphere(0.3), x0, x1, v);
    EXPECT_GE(glm::length(x1), 1.0 - 1e-7) << trial;
    if (!through) continue;
    ++hits;
    dvec3 n;
    ASSERT_TRUE(entry(x0, target, 1.0, n));
    EXPECT_NEAR(glm::dot(x1, n), 1.0, 1e-9 * glm::distance(x0, target) + 1e-7) << "trial " << trial;
    EXPECT_LE(glm::distance(x1, target), glm::distance(x0, target)) << "trial " << trial;
  }
  EXPECT_GT(hits, 10000);
}

// A particle aimed within a fifth of the radius loses what it flies inwards with, wherever its steps happen
// to end: at the entry the normal lies within asin(0.2) of the flight, so at most sin of that angle is left.
// Pushing out radially from a deep end near the equator would let it fly on.
TEST(Sphere, TurnsAsideWhatEndsDeepInside) {
  for (const double step_m : {0.35, 0.5, 1.0, 1.5, 3.0, 7.0}) {
    for (int place = 0; place < 200; ++place) {
      for (const double offset : {0.0, 0.1, 0.2}) {
        dvec3 x(-1.2 - step_m * place / 200.0, offset, 0.0), v(step_m, 0, 0);
        for (int step = 0; step < 12; ++step) {
          dvec3 x1 = x + v;
          sphere_contact(sphere(0.0), x, x1, v);
          x = x1;
        }
        EXPECT_LE(glm::length(v), 0.35 * step_m) << step_m << " " << place << " " << offset;
      }
    }
  }
}

// What is pulled in while it runs along the sphere runs on as far as its velocity says. Held where it entered
// it would stay, and the pull would make it faster and faster.
TEST(Sphere, LetsSlideWhatIsPulledIn) {
  dvec3 x(1.0, 0.0, 0.0);
  for (int step = 0; step < 20; ++step) {
    const dvec3 n = glm::normalize(x), along(-n.y, n.x, 0.0), before = x;
    dvec3 v = 0.05 * along - 0.03 * n;  // a drift of a unit of time
    x += v;
    sphere_contact(sphere(0.0), before, x, v);
    EXPECT_NEAR(glm::distance(x, before), 0.05, 2e-3) << step;
    EXPECT_NEAR(glm::length(v), 0.05, 2e-3) << step;
  }
}

// The sphere moves, the particle rests: the same in the sphere's frame.
TEST(Sphere, ThatMovesFastTakesAParticleAlong) {
  for (const double speed_m_s : {10.0, 100.0, 1000.0}) {
    const double h_s = 0.1;
    const dvec3 velocity(speed_m_s, 0, 0);
    const SphereRow<double> moving{velocity * h_s, velocity * h_s, velocity, 0.25, 0.0};  // starts at 0
    const dvec3 x0(0.5, 0.1, 0.0);
    dvec3 x1 = x0, v(0.0);
    sphere_contact(moving, x0, x1, v);
    const dvec3 n(std::sqrt(1.0 - 0.16), 0.4, 0.0);  // it is met 0.1 of 0.25 off its middle
    EXPECT_NEAR(glm::dot(x1 - moving.center, n), 0.25, 1e-9 * speed_m_s) << "passed through at " << speed_m_s;
    EXPECT_NEAR(glm::dot(v - velocity, n), 0.0, 1e-9 * speed_m_s);
    EXPECT_NEAR(v.x, 0.84 * speed_m_s, 1e-9 * speed_m_s)
        << "the share of its speed along the normal, squared";
  }
}

TEST(Sphere, PushesOutWhatStartsInside) {
  dvec3 x1(0.0, 0.0, 0.4), v(0.0, 0.0, -1.0);
  sphere_contact(sphere(0.0), dvec3(0.0, 0.0, 0.3), x1, v);
  EXPECT_EQ(x1, dvec3(0, 0, 1));
  EXPECT_EQ(v, dvec3(0, 0, 0));
  dvec3 middle(0.0), w(0.0);
  sphere_contact(sphere(0.0), dvec3(0.0), middle, w);  // no direction is better than another: up
  EXPECT_EQ(middle, dvec3(0, 1, 0));
}

TEST(Sphere, LeavesWhatMissesIt) {
  dvec3 x1(1.0, 1.01, 0.0), v(10, 0, 0);
  const dvec3 end = x1;
  sphere_contact(sphere(1.0), dvec3(-1.0, 1.01, 0.0), x1, v);
  EXPECT_EQ(x1, end);
  EXPECT_EQ(v, dvec3(10, 0, 0));
}

// |Δv_t| = min(|v_t|, μ·|Δv_n|): 3 m/s inwards and μ = 0.5 take 1.5 m/s from the slip.
TEST(Respond, FrictionIsCoulombs) {
  const dvec3 n(0, 1, 0);
  EXPECT_EQ(respond(dvec3(4, -3, 0), dvec3(0.0), n, 0.5), dvec3(2.5, 0, 0));
  EXPECT_EQ(respond(dvec3(1, -3, 0), dvec3(0.0), n, 0.5), dvec3(0, 0, 0));        // sticks
  EXPECT_EQ(respond(dvec3(4, 3, 0), dvec3(0.0), n, 0.5), dvec3(4, 3, 0));         // leaves
  EXPECT_EQ(respond(dvec3(4, -3, 0), dvec3(0.0), n, 0.0), dvec3(4, 0, 0));        // frictionless
  EXPECT_EQ(respond(dvec3(4, -1, 0), dvec3(1, 2, 0), n, 0.5), dvec3(2.5, 2, 0));  // relative to the surface
}

TEST(Floor, HoldsAtItsHeight) {
  const FloorRow<double> ground{0.5, 0.25};
  dvec3 x(1, 0.4, 2), v(2, -4, 0);
  floor_contact(ground, x, v);
  EXPECT_EQ(x, dvec3(1, 0.5, 2));
  EXPECT_EQ(v, dvec3(1, 0, 0));
  dvec3 above(1, 0.5, 2), w(2, -4, 0);
  floor_contact(ground, above, w);
  EXPECT_EQ(w, dvec3(2, -4, 0));
}

}  // namespace
}  // namespace weft
