// A study as data: looking things up in it, JSON both ways.
#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "study/identity.h"
#include "study/json_number.h"

namespace weft::study {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Cloth& c) {
  return {{"nx", c.nx},
          {"ny", c.ny},
          {"reference_solver", c.reference_solver},
          {"reference_substeps", c.reference_substeps},
          {"reference_agreement_m", json_of(c.agreement_m)},
          {"refinement_ended", c.ending},
          {"twin_drift_m", json_of(c.twin_m)},
          {"float32_floor_m", json_of(c.float_floor_m)},
          {"discretisation_m", json_of(c.discretisation_m)},
          {"fine_nx", c.fine_nx},
          {"equilibrium", c.equilibrium}};
}

Cloth cloth_from_json(const Json& json) {
  Cloth c;
  c.nx = json.at("nx");
  c.ny = json.at("ny");
  c.reference_solver = json.value("reference_solver", "rk4");
  c.reference_substeps = json.at("reference_substeps");
  c.agreement_m = number_of(json.at("reference_agreement_m"));
  c.ending = json.at("refinement_ended");
  c.twin_m = number_of(json.at("twin_drift_m"));
  c.float_floor_m = number_of(json.at("float32_floor_m"));
  c.discretisation_m = number_of(json.at("discretisation_m"));
  c.fine_nx = json.at("fine_nx");
  c.equilibrium = json.at("equilibrium");
  return c;
}

}  // namespace

const Cloth* Study::cloth(std::uint32_t nx) const {
  for (const Cloth& known : cloths)
    if (known.nx == nx) return &known;
  return nullptr;
}

std::vector<Point> Study::points_at(std::uint32_t nx) const {
  std::vector<Point> chosen;
  for (const Point& point : points)
    if (point.nx == nx) chosen.push_back(point);
  return chosen;
}

std::vector<Point> Study::promises_at(std::uint32_t nx) const {
  std::vector<Point> chosen = points_at(nx);
  const Cloth* known = cloth(nx);
  for (Point& point : chosen)
    if (known != nullptr) point.error_m = std::max(point.error_m, known->agreement_m);
  return chosen;
}

std::string to_json(const Study& study) {
  Json json = {{"format", kFormatVersion},      {"title", study.title},     {"scene", study.source},
               {"device", study.device},        {"date", study.date},       {"command", study.command},
               {"time_s", study.time_s},        {"frame_s", study.frame_s}, {"quick", study.quick},
               {"complete", study.complete},    {"cloths", Json::array()},  {"left_out", Json::array()},
               {"by_reference", Json::array()}, {"points", Json::array()}};
  for (const Cloth& cloth : study.cloths) json["cloths"].push_back(to_json(cloth));
  for (const Omission& omission : study.left_out)
    json["left_out"].push_back({{"what", omission.what}, {"reason", omission.reason}});
  for (const Omission& replaced : study.by_reference)
    json["by_reference"].push_back({{"what", replaced.what}, {"reason", replaced.reason}});
  for (const Point& point : study.points) json["points"].push_back(to_json(point));
  return json.dump(2) + '\n';
}

Study study_from_json(const std::string& text) {
  const Json json = Json::parse(text);
  if (json.at("format") != kFormatVersion) throw Json::other_error::create(501, "another format", &json);
  Study study;
  study.title = json.at("title");
  study.source = json.at("scene");
  study.device = json.at("device");
  study.date = json.at("date");
  study.command = json.at("command");
  study.time_s = json.at("time_s");
  study.frame_s = json.at("frame_s");
  study.quick = json.at("quick");
  study.complete = json.at("complete");
  for (const Json& cloth : json.at("cloths")) study.cloths.push_back(cloth_from_json(cloth));
  for (const Json& omission : json.at("left_out"))
    study.left_out.push_back({omission.at("what"), omission.at("reason")});
  if (json.contains("by_reference"))  // studies that were kept before there was native lack it
    for (const Json& replaced : json.at("by_reference"))
      study.by_reference.push_back({replaced.at("what"), replaced.at("reason")});
  for (const Json& point : json.at("points")) study.points.push_back(point_from_json(point));
  return study;
}

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min);
}

}  // namespace weft::study
