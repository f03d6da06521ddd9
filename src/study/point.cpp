// Points as JSON and CSV, and the front of those that nothing beats.
#include "study/point.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/json_number.h"

namespace weft::study {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) {
  return value ? study::json_of(*value) : Json("not measured");
}

std::optional<double> optional_of(const Json& value) {
  if (value.is_string()) return {};
  return number_of(value);
}

std::string cell(const Json& value) {
  if (value.is_null()) return "inf";
  if (value.is_string()) return value == "not measured" ? "" : value.get<std::string>();
  return value.dump();
}

}  // namespace

Json to_json(const Point& p) {
  return {{"solver", p.setting.solver},
          {"precision", p.setting.precision},
          {"substeps", p.setting.substeps},
          {"nx", p.nx},
          {"ny", p.ny},
          {"diverged", p.diverged},
          {"error_m", study::json_of(p.error_m)},
          {"ms_per_simulated_s", study::json_of(p.ms_per_s)},
          {"ms_spread", study::json_of(p.ms_spread)},
          {"runs", p.run_count},
          {"wall_clock", p.wall_clock},
          {"spring_evaluations_per_simulated_s", p.springs_per_s},
          {"spring_evaluations_per_frame", p.springs_per_frame},
          {"max_stretch", study::json_of(p.max_stretch)},
          {"p99_stretch", study::json_of(p.p99_stretch)},
          {"momentum_error_m_s", study::json_of(p.momentum_error_m_s)},
          {"energy_drift", json_of(p.energy_drift)},
          {"equilibrium_distance_m", json_of(p.equilibrium_distance_m)}};
}

Point point_from_json(const Json& json) {
  Point p;
  p.setting = {json.at("solver"), json.at("precision"), json.at("substeps")};
  p.nx = json.at("nx");
  p.ny = json.at("ny");
  p.diverged = json.at("diverged");
  p.error_m = number_of(json.at("error_m"));
  p.ms_per_s = number_of(json.at("ms_per_simulated_s"));
  p.ms_spread = number_of(json.at("ms_spread"));
  p.run_count = json.at("runs");
  p.wall_clock = json.at("wall_clock");
  p.springs_per_s = number_of(json.at("spring_evaluations_per_simulated_s"));
  p.springs_per_frame = number_of(json.at("spring_evaluations_per_frame"));
  p.max_stretch = number_of(json.at("max_stretch"));
  p.p99_stretch = number_of(json.at("p99_stretch"));
  p.momentum_error_m_s = number_of(json.at("momentum_error_m_s"));
  p.energy_drift = optional_of(json.at("energy_drift"));
  p.equilibrium_distance_m = optional_of(json.at("equilibrium_distance_m"));
  return p;
}

std::string points_csv(const std::vector<Point>& points) {
  std::string text;
  const Json names = to_json(Point{});
  std::vector<std::string> cells;
  for (const auto& [key, value] : names.items()) cells.push_back(key);
  text += fmt::format("{}\r\n", fmt::join(cells, ","));
  for (const Point& point : points) {
    cells.clear();
    const Json fields = to_json(point);
    for (const auto& [key, value] : fields.items()) cells.push_back(cell(value));
    text += fmt::format("{}\r\n", fmt::join(cells, ","));
  }
  return text;
}

std::vector<const Point*> pareto_front(const std::vector<Point>& points, double (*cost)(const Point&)) {
  std::vector<const Point*> sorted;
  for (const Point& point : points)
    if (!point.diverged && !is_reference(point)) sorted.push_back(&point);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Point* a, const Point* b) {
    return cost(*a) != cost(*b) ? cost(*a) < cost(*b) : a->error_m < b->error_m;
  });
  std::vector<const Point*> front;
  for (const Point* point : sorted)
    if (front.empty() || point->error_m < front.back()->error_m) front.push_back(point);
  return front;
}

}  // namespace weft::study
