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

constexpr double kWidth = 1020, kHeight = 640;
constexpr double kLeft = 92, kRight = 752, kTop = 104, kBottom = 566;
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
    svg_.text(0.5 * (kLeft + kRight), kHeight - 26,
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

  /// A band from the diagram's foot up to an error that something else already makes.
  void draw_floor(double error_m, const std::string& color, const std::string& words, bool on_the_right) {
    if (!(error_m > 0.0) || !std::isfinite(error_m)) return;
    const double y = std::min(y_.at(error_m), kBottom);
    svg_.rectangle(kLeft, y, kRight - kLeft, kBottom - y, {.fill = color, .opacity = 0.14});
    if (y >= kBottom - 1) return;
    svg_.line({kLeft, y}, {kRight, y}, {.stroke = color, .width = 1.4, .dash = "8 5"});
    note(on_the_right ? kRight - 8 : kLeft + 8, std::min(y + 16, kBottom - 5), words,
         {.size = 12, .anchor = on_the_right ? "end" : "start", .color = color});
  }

  /// Words on a paper-coloured ground, so that no line runs through them.
  void note(double x, double y, const std::string& words, const Words& look) {
    const double width = 0.55 * look.size * static_cast<double>(words.size());
    svg_.rectangle(look.anchor == "end" ? x - width : x - 3, y - 0.85 * look.size, width + 3,
                   1.15 * look.size, {.fill = "#ffffff", .opacity = 0.75});
    svg_.text(x, y, words, look);
  }

  void draw_floors() {
    draw_floor(cloth_.twin_m, "#555555", "twins 1e-7 m apart drift this far", true);
    draw_floor(cloth_.float_floor_m, "#8a4b08", "leapfrog in float32 against itself at half the step", false);
    draw_floor(cloth_.agreement_m, "#7a0019", "the reference is known to this", true);
    if (!(cloth_.discretisation_m > 0.0)) return;
    const double y = y_.at(cloth_.discretisation_m);
    svg_.line({kLeft, y}, {kRight, y}, {.stroke = "#4a2c7a", .width = 1.4, .dash = "10 4 2 4"});
    svg_.text(kRight - 8, y - 6,
              fmt::format("the same cloth with {} particles along the width", cloth_.fine_nx),
              {.size = 12, .anchor = "end", .color = "#4a2c7a"});
  }

  void draw_real_time() {
    if (axis_ != CostAxis::device_time || !x_.contains(kRealTime_ms_per_s)) return;
    const double x = x_.at(kRealTime_ms_per_s);
    svg_.line({x, kTop - kMargin}, {x, kBottom}, {.stroke = "#b00020", .width = 1.8});
    svg_.text(x - 5, kBottom - 10, "real time", {.size = 13, .color = "#b00020", .turned_deg = -90});
  }

  void draw_front() {
    std::vector<PicturePoint> line;
    for (const Point* point : pareto_front(points_, cost_)) line.push_back(place(*point));
    if (line.size() > 1) svg_.path(line, false, {.stroke = "#f0e442", .width = 11, .opacity = 0.8});
  }

  void draw_front_labels() {
    for (const Point* point : pareto_front(points_, cost_))
      svg_.text(place(*point).first - 9, place(*point).second + 14, std::to_string(point->setting.substeps),
                {.size = 11, .anchor = "end", .color = "#222222"});
  }

  void draw_series(const Series& series) {
    std::vector<PicturePoint> line;
    for (const Point& point : series.points)
      if (!point.diverged) line.push_back(place(point));
    if (line.size() > 1)
      svg_.path(line, false,
                {.stroke = solver_color(series.solver), .width = 2.0, .dash = dash_of(series.precision)});
    for (const Point& point : series.points) {
      const double x = x_.at(cost_(point));
      if (!point.diverged) {
        draw_marker(svg_, series.solver, x, y_.at(point.error_m), series.precision == "f64");
        continue;
      }
      const double y = kTop - 0.5 * kMargin;
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
    words(x_.contains(kRealTime_ms_per_s) ? "real time" : "real time: out of range");
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
