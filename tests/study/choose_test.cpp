// Laws of the front and of choosing, on many random sets of points.
#include "study/choose.h"

#include <gtest/gtest.h>

#include "study_cloths.h"

namespace weft::study {
namespace {

bool beats(const Point& a, const Point& b) {
  return a.ms_per_s <= b.ms_per_s && a.error_m <= b.error_m &&
         (a.ms_per_s < b.ms_per_s || a.error_m < b.error_m);
}

TEST(Front, HoldsExactlyWhatNothingBeats) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 500; ++round) {
    const std::vector<Point> points = random_points(random);
    const std::vector<const Point*> front = pareto_front(points, time_cost);
    for (std::size_t f = 1; f < front.size(); ++f) {
      EXPECT_LT(front[f - 1]->ms_per_s, front[f]->ms_per_s);
      EXPECT_GT(front[f - 1]->error_m, front[f]->error_m);
    }
    for (const Point& point : points) {
      if (point.diverged) continue;
      bool beaten = false, on_front = false;
      for (const Point& other : points) beaten = beaten || (!other.diverged && beats(other, point));
      for (const Point* member : front)
        on_front = on_front || (member->ms_per_s == point.ms_per_s && member->error_m == point.error_m);
      EXPECT_NE(beaten, on_front);
    }
  }
}

// Where halving the reference's step helps no more, one of the runs may be the reference itself.
TEST(Front, LeavesOutWhatIsTheReferenceItself) {
  std::vector<Point> points(2);
  points[0].error_m = 1e-3;
  points[0].ms_per_s = 1.0;
  points[1].error_m = 0.0;
  points[1].ms_per_s = 2.0;
  const std::vector<const Point*> front = pareto_front(points, time_cost);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0], &points[0]);
}

TEST(Choosing, ACoarserWishNeverCostsMore) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 500; ++round) {
    const std::vector<Point> points = random_points(random);
    double cost_before = std::numeric_limits<double>::infinity();
    for (double wish_m = 1e-5; wish_m < 10.0; wish_m *= 1.3) {
      const auto chosen = choose_for_error(points, wish_m);
      if (!chosen) {
        EXPECT_TRUE(std::isinf(cost_before)) << "a coarser wish found nothing where a finer one did";
        continue;
      }
      EXPECT_LT(chosen->error_m, wish_m);
      EXPECT_FALSE(chosen->diverged);
      EXPECT_LE(chosen->ms_per_s, cost_before);
      cost_before = chosen->ms_per_s;
    }
  }
}

TEST(Choosing, ALargerBudgetIsNeverLessAccurate) {
  constexpr double kFrame_s = 0.01;
  std::mt19937_64 random(3);
  for (int round = 0; round < 500; ++round) {
    const std::vector<Point> points = random_points(random);
    double error_before_m = std::numeric_limits<double>::infinity();
    for (double budget_ms = 1e-3; budget_ms < 1e3; budget_ms *= 1.3) {
      const auto chosen = choose_for_budget(points, budget_ms, kFrame_s);
      if (!chosen) continue;
      EXPECT_LE(chosen->ms_per_s * kFrame_s, budget_ms);
      EXPECT_LE(chosen->error_m, error_before_m);
      error_before_m = chosen->error_m;
    }
  }
}

TEST(Choosing, TakesTheCheapestBelowAndTheMostAccurateWithin) {
  const std::vector<Point> points{point_of(10, 1e-2), point_of(100, 1e-4), point_of(60, 2e-4),
                                  point_of(1, 1e-9, true)};
  EXPECT_EQ(choose_for_error(points, 1e-3)->ms_per_s, 60);
  EXPECT_EQ(choose_for_error(points, 2e-4)->ms_per_s, 100);  // below, not equal
  EXPECT_FALSE(choose_for_error(points, 1e-5));
  EXPECT_EQ(choose_for_budget(points, 70.0, 1.0)->ms_per_s, 60);
  EXPECT_FALSE(choose_for_budget(points, 9.9, 1.0));
  EXPECT_EQ(most_accurate(points)->error_m, 1e-4);
  EXPECT_EQ(cheapest(points)->ms_per_s, 10);
  EXPECT_FALSE(most_accurate({point_of(1, 1, true)}));
}

}  // namespace
}  // namespace weft::study
