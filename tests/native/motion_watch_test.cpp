// When nobody has to look whether particles have left the lists' room, on made-up motion: no cloth is swept.
#include "native/motion_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace weft {
namespace {

constexpr double kRoom_m = 0.01;
constexpr float kDrift_s = 1e-4f;

/// Particles on a line that gain and lose speed at random, some of them suddenly.
struct Crowd {
  std::vector<float> x = std::vector<float>(50, 1.0f), built = x, v = std::vector<float>(50, 0.0f);
  std::mt19937_64 random;

  explicit Crowd(std::uint64_t seed) : random(seed) {}
  /// Returns the longest way of a substep.
  float step(float jolt_m_s, double jolts) {
    std::normal_distribution<float> gain(0.0f, 0.02f);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    float longest = 0.0f;
    for (std::size_t p = 0; p < x.size(); ++p) {
      v[p] += gain(random);
      if (any(random) < jolts) v[p] = any(random) < 0.5 ? jolt_m_s : -jolt_m_s;
      const float before = x[p];
      x[p] = before + kDrift_s * v[p];
      longest = std::max(longest, std::abs(x[p] - before));
    }
    return longest;
  }
  float gone() const {
    float most = 0.0f;
    for (std::size_t p = 0; p < x.size(); ++p) most = std::max(most, std::abs(x[p] - built[p]));
    return most;
  }
  float speed() const {
    return std::abs(*std::ranges::max_element(v, {}, [](float s) { return std::abs(s); }));
  }
};

// The promise of MotionWatch: whenever it says so everybody is in the room, whatever they did. And it is
// worth having: where speeds change slowly it takes a look in few of the substeps.
TEST(NativeMotionWatch, SaysThatAllAreInOnlyWhereTheyAre) {
  for (const double jolts : {0.0, 1e-4, 1e-2})
    for (const float jolt_m_s : {1.0f, 30.0f, 300.0f}) {
      Crowd crowd(static_cast<std::uint64_t>(1e6 * jolts + jolt_m_s));
      native::MotionWatch watch(kRoom_m);
      int looks = 0;
      for (int substep = 0; substep < 4000; ++substep) {
        if (watch.all_are_in()) {
          ASSERT_LE(crowd.gone(), kRoom_m) << substep;
        } else {
          ++looks;
          watch.measured(crowd.gone() * crowd.gone(), crowd.speed() * crowd.speed(), 1.0f);
          if (crowd.gone() > kRoom_m) {
            crowd.built = crowd.x;
            watch.lists_made();
          }
        }
        const float way = crowd.step(jolt_m_s, jolts);
        if (!(way * way < watch.leap2())) watch.tell_leap();
        watch.tell_sweeps(1, kDrift_s);
      }
      if (jolts == 0.0) {
        EXPECT_LT(looks, 400);
      }
    }
}

// Substeps may be swept at once where nobody would look in between: in each but the last everybody is in the
// room, and what somebody leapt in is taken back as if it had not been.
TEST(NativeMotionWatch, SweepsAheadOnlyWhereNobodyWouldLook) {
  for (const double jolts : {0.0, 1e-4, 1e-3}) {
    Crowd crowd(static_cast<std::uint64_t>(1e6 * jolts) + 7);
    native::MotionWatch watch(kRoom_m);
    std::uint32_t ahead = 0, taken_back = 0;
    const auto step = [&] {
      const float way = crowd.step(30.0f, jolts);
      if (!(way * way < watch.leap2())) watch.tell_leap();
    };
    for (std::uint32_t substep = 0; substep < 4000;) {
      if (!watch.all_are_in()) {
        watch.measured(crowd.gone() * crowd.gone(), crowd.speed() * crowd.speed(), 1.0f);
        if (crowd.gone() > kRoom_m) {
          crowd.built = crowd.x;
          watch.lists_made();
        }
      }
      const Crowd before = crowd;
      const std::uint32_t quiet = watch.quiet_substeps();
      float farthest = 0.0f;
      for (std::uint32_t k = 0; k < quiet; ++k) {
        farthest = std::max(farthest, crowd.gone());
        step();
      }
      watch.tell_sweeps(quiet, kDrift_s);
      if (quiet > 0 && !watch.has_leapt()) {
        ASSERT_LE(farthest, kRoom_m) << substep;
        watch.tell_ahead(quiet);
        ahead += quiet;
        substep += quiet;
        continue;
      }
      if (quiet > 0) {
        const auto random = crowd.random;
        crowd = before;
        crowd.random = random;  // or the same leap would come for ever
        watch.take_back(quiet);
        ++taken_back;
        EXPECT_TRUE(watch.all_are_in());
        EXPECT_EQ(watch.quiet_substeps(), 0u) << "one by one, until somebody leaps";
      }
      step();
      watch.tell_sweeps(1, kDrift_s);
      ++substep;
    }
    EXPECT_GT(ahead, jolts == 0.0 ? 3000u : 100u);
    if (jolts > 0.0) {
      EXPECT_GT(taken_back, 0u);
    }
  }
}

/// Before anybody has been measured, and once they have been moved otherwise, a look is due; lists that are
/// made do not change that.
TEST(NativeMotionWatch, LooksWhereNobodyHasBeenMeasured) {
  native::MotionWatch watch(kRoom_m);
  EXPECT_FALSE(watch.all_are_in());
  watch.lists_made();
  EXPECT_FALSE(watch.all_are_in());
  watch.tell_sweeps(1, kDrift_s);
  watch.measured(0.0f, 1.0f, 1.0f);
  EXPECT_TRUE(watch.all_are_in());
  watch.forget();
  watch.lists_made();
  EXPECT_FALSE(watch.all_are_in());
}

}  // namespace
}  // namespace weft
