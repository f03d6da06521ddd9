// Drawing the diagram: scales, then floors, front, lines, markers, legend, from back to front.
#include "study/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "study/chart_scale.h"
#include "study/series.h"
#include "study/svg.h"

namespace weft::study {
namespace {

constexpr double kWidth = 1020, kHeight = 692;
constexpr double kLeft = 92, kRight = 752, kTop = 104, kBottom = 566;
constexpr double kAxisTitle = 614, kFloorRows = 640, kFloorPitch = 22;
constexpr double kMargin = 30;  // above the plot, where diverged settings stand
constexpr double kRealTime_ms_per_s = 1000.0;
constexpr double kMarker = 5.0;

std::string dash_of(std::string_view precision) {
  if (precision == "f64") return "2 4";
  return precision == "f32k" ? "9 4" : "";
}

std::vector<PicturePoint> polygon(double x, double y, int sides, double radius, double turn) {
  std::vector<PicturePoint> points;
  for (int s = 0; s < sides; ++s) {
    const double angle = turn + 2.0 * std::numbers::pi * s / sides;
    points.emplace_back(x + radius * std::sin(angle), y - radius * std::cos(angle));
  }
  return points;
}

void draw_marker(Svg& svg, std::string_view solver, double x, double y, bool hollow) {
  const std::string color = solver_color(solver);
  const Paint paint{.fill = hollow ? "#ffffff" : color, .stroke = hollow ? color : "#ffffff", .width = 1.2};
  const Marker marker = solver_marker(solver);
  if (marker.sides == 0) return svg.circle(x, y, kMarker, paint);
  svg.path(polygon(x, y, marker.sides, marker.radius * kMarker, marker.turn_rad), true, paint);
}

class Diagram {
 public:
  Diagram(const Study& study, std::uint32_t nx, CostAxis axis)
      : study_(study),
        cloth_(*study.cloth(nx)),
        points_(study.points_at(nx)),
        cost_(axis == CostAxis::device_time ? time_cost : spring_cost),
        axis_(axis),
        x_(kLeft, kRight),
        y_(kBottom, kTop) {
    for (const Point& point : points_) {
      if (is_reference(point)) continue;
      x_.include(cost_(point));
      if (!point.diverged) y_.include(point.error_m);
    }
    y_.include(cloth_.twin_m);
    y_.include(cloth_.float_floor_m);
    if (cloth_.discretisation_m > 0.0) y_.include(cloth_.discretisation_m);
    if (axis == CostAxis::device_time && x_.within(kRealTime_ms_per_s, 1.2)) x_.include(kRealTime_ms_per_s);
    x_.widen(0.12);
    y_.widen(0.25);
  }

  std::string draw() {
    svg_.rectangle(0, 0, kWidth, kHeight, {.fill = "#ffffff"});
    draw_titles();
    draw_grid();
    draw_floors();
    draw_real_time();
    draw_front();
    for (const Series& series : series_of(points_)) draw_series(series);
    draw_front_labels();
    svg_.rectangle(kLeft, kTop - kMargin, kRight - kLeft, kBottom - kTop + kMargin,
                   {.stroke = "#222222", .width = 1.2});
    draw_legend();
    draw_floor_rows();
    return svg_.document(study_.title + ": work-precision diagram");
  }

 private:
  PicturePoint place(const Point& point) const { return {x_.at(cost_(point)), y_.at(point.error_m)}; }

  void draw_titles() {
    svg_.text(kLeft, 30,
              fmt::format("{} · {} × {} particles · first {:g} s", study_.title, cloth_.nx, cloth_.ny,
                          study_.time_s),
              {.size = 19, .bold = true});
    svg_.text(kLeft, 54, fmt::format("{} · {}", study_.device, study_.date),
              {.size = 14, .color = "#555555"});
    const bool wall =
        std::any_of(points_.begin(), points_.end(), [](const Point& p) { return p.wall_clock; });
    const std::string time =
        wall ? "wall time [ms per simulated second]" : "device time [ms per simulated second]";
    svg_.text(0.5 * (kLeft + kRight), kAxisTitle,
              axis_ == CostAxis::device_time ? time : "spring evaluations per simulated second",
              {.size = 15, .anchor = "middle"});
    svg_.text(26, 0.5 * (kTop + kBottom), "error: largest RMS distance to the reference [m]",
              {.size = 15, .anchor = "middle", .turned_deg = -90});
  }

  void draw_grid() {
    for (const Tick& tick : x_.ticks()) {
      const double x = x_.at(tick.value);
      svg_.line({x, kTop - kMargin}, {x, kBottom}, {.stroke = "#c8c8c8", .width = tick.major ? 0.9 : 0.4});
      if (tick.major) svg_.text(x, kBottom + 22, tick.label, {.anchor = "middle"});
    }
    for (const Tick& tick : y_.ticks()) {
      const double y = y_.at(tick.value);
      svg_.line({kLeft, y}, {kRight, y}, {.stroke = "#c8c8c8", .width = tick.major ? 0.9 : 0.4});
      if (tick.major) svg_.text(kLeft - 9, y + 5, tick.label, {.anchor = "end"});
    }
    svg_.line({kLeft, kTop}, {kRight, kTop}, {.stroke = "#888888", .dash = "3 3"});
    svg_.text(kLeft - 9, kTop - 9, "diverged", {.size = 13, .anchor = "end"});
  }

  /// What bounds the meaning of an error: a line across the plot, shaded below where errors mean nothing.
  struct Floor {
    double error_m;
    const char *color, *dash;
    bool shaded;
    std::string words;
  };

  /// Those that are known, from the largest error to the least.
  std::vector<Floor> floors() const {
    std::vector<Floor> list;
    const auto add = [&](double error_m, const char* color, const char* dash, bool shaded,
                         const std::string& words) {
      if (error_m > 0.0 && std::isfinite(error_m))
        list.push_back({error_m, color, dash, shaded, fmt::format("{}: {:.1e} m", words, error_m)});
    };
    add(cloth_.discretisation_m, "#4a2c7a", "10 4 2 4", false,
        fmt::format("the same cloth, {} particles wide", cloth_.fine_nx));
    add(cloth_.twin_m, "#555555", "8 5", true, "twins 1e-7 m apart drift this far");
    add(cloth_.float_floor_m, "#8a4b08", "3 3", true, "leapfrog in float32, against half its step");
    add(cloth_.agreement_m, "#7a0019", "14 4", true, "the reference is known to this");
    return list;
  }

  void draw_floors() {
    for (const Floor& floor : floors()) {
      const double y = std::min(y_.at(floor.error_m), kBottom);
      if (floor.shaded)
        svg_.rectangle(kLeft, y, kRight - kLeft, kBottom - y, {.fill = floor.color, .opacity = 0.14});
      if (y < kBottom - 1)
        svg_.line({kLeft, y}, {kRight, y}, {.stroke = floor.color, .width = 1.6, .dash = floor.dash});
    }
  }

  /// The floors' names and numbers, two columns under the axis: in the plot they would lie under the data.
  void draw_floor_rows() {
    std::size_t row = 0;
    for (const Floor& floor : floors()) {
      const double x = kLeft + (row % 2 == 0 ? 0.0 : 450.0);
      const double y = kFloorRows + kFloorPitch * static_cast<double>(row / 2);
      if (floor.shaded) svg_.rectangle(x, y, 40, 9, {.fill = floor.color, .opacity = 0.14});
      svg_.line({x, y}, {x + 40, y}, {.stroke = floor.color, .width = 1.6, .dash = floor.dash});
      svg_.text(x + 50, y + 5, floor.words, {.size = 13, .color = floor.color});
      ++row;
    }
  }

  void draw_real_time() {
    if (axis_ != CostAxis::device_time || !x_.contains(kRealTime_ms_per_s)) return;
    const double x = x_.at(kRealTime_ms_per_s);
    svg_.line({x, kTop - kMargin}, {x, kBottom}, {.stroke = "#b00020", .width = 1.8});
  }

  void draw_front() {
    std::vector<PicturePoint> line;
    for (const Point* point : pareto_front(points_, cost_)) line.push_back(place(*point));
    if (line.size() > 1) svg_.path(line, false, {.stroke = "#f0e442", .width = 11, .opacity = 0.8});
  }

  /// Substeps beside the front's markers, on a paper-coloured ground, so that no line runs through them.
  void draw_front_labels() {
    for (const Point* point : pareto_front(points_, cost_)) {
      const std::string words = std::to_string(point->setting.substeps);
      const double x = place(*point).first - 9, y = std::min(place(*point).second + 15, kBottom - 3);
      const double width = 7.2 * static_cast<double>(words.size());
      svg_.rectangle(x - width - 1, y - 9, width + 2, 11, {.fill = "#ffffff", .opacity = 0.8});
      svg_.text(x, y, words, {.size = 11, .anchor = "end", .color = "#222222"});
    }
  }

  void draw_series(const Series& series) {
    std::vector<PicturePoint> line;
    for (const Point& point : series.points)
      if (!point.diverged && !is_reference(point)) line.push_back(place(point));
    if (line.size() > 1)
      svg_.path(line, false,
                {.stroke = solver_color(series.solver), .width = 2.0, .dash = dash_of(series.precision)});
    for (const Point& point : series.points) {
      if (is_reference(point)) continue;
      const double x = x_.at(cost_(point));
      if (!point.diverged) {
        draw_marker(svg_, series.solver, x, y_.at(point.error_m), series.precision == "f64");
        continue;
      }
      // A height of its own for each solver, so that crosses at the same cost can be told apart.
      const double y = kTop - 0.5 * kMargin + 2.4 * (static_cast<double>(solver_place(series.solver)) - 3.5);
      const Paint cross{.stroke = solver_color(series.solver), .width = 2.2};
      svg_.line({x - 5, y - 5}, {x + 5, y + 5}, cross);
      svg_.line({x - 5, y + 5}, {x + 5, y - 5}, cross);
    }
  }

  void draw_legend() {
    const double x = kRight + 22;
    double y = kTop - 14;
    const auto words = [&](const std::string& text) {
      svg_.text(x + 50, y + 5, text, {.size = 13});
      y += 23;
    };
    for (const Series& series : series_of(points_)) {
      svg_.line({x, y}, {x + 40, y},
                {.stroke = solver_color(series.solver), .width = 2.0, .dash = dash_of(series.precision)});
      draw_marker(svg_, series.solver, x + 20, y, series.precision == "f64");
      words(series.solver + " " + series.precision);
    }
    y += 8;
    svg_.line({x, y}, {x + 40, y}, {.stroke = "#f0e442", .width = 11, .opacity = 0.8});
    words("nothing beats these");
    svg_.text(x + 50, y, "(substeps a frame beside)", {.size = 11, .color = "#555555"});
    y += 22;
    svg_.line({x + 15, y - 5}, {x + 25, y + 5}, {.stroke = "#222222", .width = 2.2});
    svg_.line({x + 15, y + 5}, {x + 25, y - 5}, {.stroke = "#222222", .width = 2.2});
    words("diverged");
    if (axis_ != CostAxis::device_time) return;
    svg_.line({x + 20, y - 9}, {x + 20, y + 9}, {.stroke = "#b00020", .width = 1.8});
    words(x_.contains(kRealTime_ms_per_s) ? "real time: 1000 ms" : "real time: out of range");
  }

  const Study& study_;
  const Cloth& cloth_;
  std::vector<Point> points_;
  double (*cost_)(const Point&);
  CostAxis axis_;
  LogScale x_, y_;
  Svg svg_{kWidth, kHeight};
};

}  // namespace

std::string work_precision_svg(const Study& study, std::uint32_t nx, CostAxis axis) {
  return Diagram(study, nx, axis).draw();
}

}  // namespace weft::study
