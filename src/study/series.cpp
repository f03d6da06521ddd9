// The order of the list of solvers decides over colours and markers.
#include "study/series.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "solvers/solver.h"

namespace weft::study {
namespace {

// Okabe and Ito, Color Universal Design (2008); the yellow, too light on white, comes last.
constexpr std::array kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                "#000000", "#e69f00", "#56b4e9", "#b8a800"};

constexpr double kPi = std::numbers::pi;
constexpr std::array kMarkers = {Marker{},
                                 Marker{4, 1.35, kPi / 4},  // square
                                 Marker{3, 1.45, 0.0},      // triangle
                                 Marker{4, 1.4, 0.0},       // diamond
                                 Marker{3, 1.45, kPi},      // triangle, point down
                                 Marker{5, 1.35, 0.0},      // pentagon
                                 Marker{3, 1.45, kPi / 2},  // triangle to the right
                                 Marker{6, 1.3, 0.0}};

}  // namespace

std::size_t solver_place(std::string_view name) {
  const auto list = solvers();
  for (std::size_t s = 0; s < list.size(); ++s)
    if (list[s]->name == name) return s;
  return list.size();
}

std::vector<Series> series_of(const std::vector<Point>& points) {
  std::vector<Series> list;
  for (const Point& point : points) {
    auto at = std::find_if(list.begin(), list.end(), [&](const Series& s) {
      return s.solver == point.setting.solver && s.precision == point.setting.precision;
    });
    if (at == list.end()) at = list.insert(at, {point.setting.solver, point.setting.precision, {}});
    at->points.push_back(point);
  }
  for (Series& series : list)
    std::sort(series.points.begin(), series.points.end(),
              [](const Point& a, const Point& b) { return a.setting.substeps < b.setting.substeps; });
  std::stable_sort(list.begin(), list.end(), [](const Series& a, const Series& b) {
    return solver_place(a.solver) < solver_place(b.solver);
  });
  return list;
}

std::string solver_color(std::string_view solver) { return kColors[solver_place(solver) % kColors.size()]; }

Marker solver_marker(std::string_view solver) { return kMarkers[solver_place(solver) % kMarkers.size()]; }

}  // namespace weft::study
