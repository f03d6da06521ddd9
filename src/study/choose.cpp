// Both choices walk the points once; diverged ones are never chosen.
#include "study/choose.h"

#include <limits>
#include <tuple>

namespace weft::study {
namespace {

/// The least point by `key` among those that `fits`.
template <class Fits, class Key>
std::optional<Point> least(const std::vector<Point>& points, Fits&& fits, Key&& key) {
  const Point* best = nullptr;
  for (const Point& point : points)
    if (!point.diverged && fits(point) && (best == nullptr || key(point) < key(*best))) best = &point;
  return best != nullptr ? std::optional<Point>(*best) : std::nullopt;
}

auto cost_first(const Point& p) { return std::tuple(p.ms_per_s, p.error_m); }
auto error_first(const Point& p) { return std::tuple(p.error_m, p.ms_per_s); }
bool any(const Point&) { return true; }

}  // namespace

std::optional<Point> choose_for_error(const std::vector<Point>& points, double error_m) {
  return least(
      points, [&](const Point& p) { return p.error_m < error_m; }, cost_first);
}

std::optional<Point> choose_for_budget(const std::vector<Point>& points, double budget_ms, double frame_s) {
  return least(
      points, [&](const Point& p) { return ms_per_frame(p, frame_s) <= budget_ms; }, error_first);
}

std::optional<Point> most_accurate(const std::vector<Point>& points) {
  return least(points, any, error_first);
}

std::optional<Point> cheapest(const std::vector<Point>& points) { return least(points, any, cost_first); }

}  // namespace weft::study
