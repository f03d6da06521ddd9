// The page of a study: diagrams, what they mean, every number in a table. Self-contained HTML.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/chart.h"
#include "study/report.h"
#include "study/svg.h"

namespace weft::study {
namespace {

constexpr const char* kStyle =
    "body{font:16px/1.5 'DejaVu Sans',Verdana,Arial,sans-serif;color:#222;max-width:1040px;margin:2em auto;"
    "padding:0 1em}h1{font-size:1.6em}h2{margin-top:2em}svg{max-width:100%;height:auto}"
    "table{border-collapse:collapse;font-size:.82em;font-variant-numeric:tabular-nums}"
    "th,td{padding:.2em .6em;text-align:right;border-bottom:1px solid #ddd}th{border-bottom:2px solid #222}"
    "td:first-child,th:first-child{text-align:left}tr.diverged td{color:#b00020}tr.front "
    "td{background:#fbf8c4}"
    "code{background:#f2f2f2;padding:.1em .3em}.wide{overflow-x:auto}";

std::string metres(double value) { return std::isfinite(value) ? fmt::format("{:.2e}", value) : "–"; }

std::string number(double value, int digits = 3) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "–";
}

std::string cell(const std::optional<double>& value) { return value ? metres(*value) : ""; }

std::string row(const Point& p, double frame_s, bool on_front) {
  const char* kind = p.diverged ? " class=\"diverged\"" : on_front ? " class=\"front\"" : "";
  return fmt::format(
      "<tr{}><td>{} {}</td><td>{}</td><td>{}</td><td>{}</td><td>±{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
      kind, escaped(p.setting.solver), escaped(p.setting.precision), p.setting.substeps,
      p.diverged ? "diverged" : metres(p.error_m), number(p.ms_per_s), number(p.ms_spread, 2),
      number(ms_per_frame(p, frame_s)), number(p.springs_per_frame), p.diverged ? "" : number(p.max_stretch),
      p.diverged ? "" : number(p.p99_stretch), p.diverged ? "" : metres(p.momentum_error_m_s),
      cell(p.energy_drift), cell(p.equilibrium_distance_m));
}

std::string table(const Study& study, std::uint32_t nx) {
  std::string text =
      "<div class=\"wide\"><table><tr><th>solver</th><th>substeps a frame</th><th>error [m]</th>"
      "<th>ms per simulated s</th><th>spread</th><th>ms a frame</th><th>springs a frame</th><th>max stretch"
      "</th><th>p99 stretch</th><th>momentum error [m/s]</th><th>energy drift</th><th>to rest "
      "[m]</th></tr>\n";
  const std::vector<Point> points = study.points_at(nx);
  const std::vector<const Point*> front = pareto_front(points, time_cost);
  std::vector<const Point*> sorted;
  for (const Point& point : points) sorted.push_back(&point);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Point* a, const Point* b) {
    return std::tie(a->setting.solver, a->setting.precision, a->setting.substeps) <
           std::tie(b->setting.solver, b->setting.precision, b->setting.substeps);
  });
  for (const Point* point : sorted)
    text += row(*point, study.frame_s, std::find(front.begin(), front.end(), point) != front.end());
  return text + "</table></div>\n";
}

std::string reference_text(const Cloth& cloth, double time_s) {
  std::string text = fmt::format(
      "<p>Reference: {} in double at {} substeps a frame; its two finest refinements agree to {} m ({}). "
      "Two double-precision runs started 1e-7 m apart drift by {} m within {:g} s: below that a comparison "
      "of trajectories means nothing. Single precision differs from itself at half the step by {} m at "
      "least.",
      cloth.reference_solver, cloth.reference_substeps, metres(cloth.agreement_m),
      cloth.ending == "agreed"    ? "they agree as asked for"
      : cloth.ending == "no gain" ? "a finer step no longer helps"
                                  : "the time allowed ended the refinement",
      metres(cloth.twin_m), time_s, metres(cloth.float_floor_m));
  if (cloth.discretisation_m >= 0.0)
    text += fmt::format(
        " The same cloth with {} particles along the width moves {} m away from this one: a "
        "smaller error of a solver is more exact than the grid.",
        cloth.fine_nx, metres(cloth.discretisation_m));
  text += cloth.equilibrium == "found"
              ? " “To rest” is the distance of the last frame to the static equilibrium, found by "
                "Newton's method to 1e-9 N."
              : fmt::format(" No static equilibrium: {}.", escaped(cloth.equilibrium));
  return text + "</p>\n";
}

std::string list_of(const char* title, const std::vector<Omission>& omissions) {
  if (omissions.empty()) return "";
  std::string text = fmt::format("<h2>{}</h2>\n<ul>\n", title);
  for (const Omission& omission : omissions)
    text += fmt::format("<li>{}: {}</li>\n", escaped(omission.what), escaped(omission.reason));
  return text + "</ul>\n";
}

}  // namespace

std::string report_html(const Study& study) {
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: what accuracy "
      "costs</title>"
      "<style>{1}</style></head><body>\n<h1>{0}: what accuracy costs</h1>\n<p>{2} · {3}{4}</p>\n<p><code>{5}"
      "</code></p>\n<p>The error of a setting is the largest, over the output frames of the first {6:g} s, "
      "of "
      "the root mean square over particles of the distance to a converged reference of the same cloth. Its "
      "time is {7}, the median of several warm runs; the spread is half the distance between the fastest and "
      "the slowest. Settings that diverged stay in the table. Marked rows are those that no other beats in "
      "both error and time.</p>\n",
      escaped(study.title), kStyle, escaped(study.device), escaped(study.date),
      study.quick ? " · quick form" : "", escaped(study.command), study.time_s,
      !study.points.empty() && study.points.front().wall_clock ? "wall time" : "the device's own timestamps");
  for (const Cloth& cloth : study.cloths) {
    page += fmt::format("<h2>{} × {} particles</h2>\n", cloth.nx, cloth.ny);
    page += work_precision_svg(study, cloth.nx, CostAxis::device_time);
    page += reference_text(cloth, study.time_s);
    page += work_precision_svg(study, cloth.nx, CostAxis::spring_evaluations);
    page += "<p>Spring evaluations do not depend on the machine.</p>\n" + table(study, cloth.nx);
  }
  page += list_of("Left out", study.left_out);
  page += list_of("Run by the CPU reference", study.by_reference);
  return page + "</body></html>\n";
}

}  // namespace weft::study
