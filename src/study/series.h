// How the points of a study are told apart in every diagram: a line a solver and precision, a colour and a
// marker a solver.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "study/point.h"

namespace weft::study {

/// Points of one solver and precision, by rising substeps.
struct Series {
  std::string solver, precision;
  std::vector<Point> points;
};

/// The points as lines, in the order of the list of solvers.
std::vector<Series> series_of(const std::vector<Point>& points);

/// A solver's place in the list of solvers; their number for a name that is not there.
std::size_t solver_place(std::string_view name);

/// A solver's colour ("#rrggbb") in every diagram: those of Okabe and Ito, told apart by everyone.
std::string solver_color(std::string_view solver);

/// A solver's marker: a regular polygon, or a circle.
struct Marker {
  int sides = 0;          ///< 0: a circle
  double radius = 1.0;    ///< so that all look equally large, in units of a circle's
  double turn_rad = 0.0;  ///< of the first corner, clockwise from the top
};
Marker solver_marker(std::string_view solver);

}  // namespace weft::study
