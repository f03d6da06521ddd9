// The same axes as the report's diagram: what was measured, the floors, and real time when it is near.
#include "viewer/diagram_layout.h"

#include <cmath>

namespace weft {

DiagramLayout::DiagramLayout(const study::Study& study, std::uint32_t nx, const PlotBox& box,
                             std::optional<double> live_ms_per_s)
    : box_(box), x_(box.left, box.right), y_(box.bottom, box.top + kMargin) {
  const std::vector<study::Point> points = study.points_at(nx);
  for (const study::Point& point : points) {
    x_.include(point.ms_per_s);
    if (!point.diverged) y_.include(point.error_m);
  }
  if (const study::Cloth* cloth = study.cloth(nx)) {
    y_.include(cloth->twin_m);
    y_.include(cloth->float_floor_m);
  }
  if (live_ms_per_s) x_.include(*live_ms_per_s);
  if (x_.within(kRealTime_ms_per_s, 1.2)) x_.include(kRealTime_ms_per_s);
  x_.widen(0.12);
  y_.widen(0.25);
  x_ticks_ = x_.ticks();
  y_ticks_ = y_.ticks();
  const auto place = [&](const study::Point& point) {
    return PlotPlace{x_at(point.ms_per_s), point.diverged ? box.top + 0.5f * kMargin : y_at(point.error_m)};
  };
  for (const study::Series& series : study::series_of(points)) {
    PlotLine& line = lines_.emplace_back(PlotLine{series.solver, series.precision, {}});
    for (const study::Point& point : series.points)
      if (!study::is_reference(point)) line.marks.push_back({point, place(point)});
  }
  for (const study::Point* point : study::pareto_front(points, study::time_cost))
    front_.push_back(place(*point));
}

const PlotMark* DiagramLayout::nearest(const PlotPlace& place, float reach) const {
  const PlotMark* best = nullptr;
  for (const PlotLine& line : lines_)
    for (const PlotMark& mark : line.marks) {
      const float away = std::hypot(mark.place.x - place.x, mark.place.y - place.y);
      if (away > reach) continue;
      reach = away;
      best = &mark;
    }
  return best;
}

}  // namespace weft
