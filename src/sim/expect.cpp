// Evaluates a scene's [expect] block.
#include "sim/expect.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "model/measures.h"

namespace weft {
namespace {

/// Lowest and highest particle [m]; not a number when any height is not one.
std::pair<double, double> heights(const State& state) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const glm::dvec3& position : state.position) {
    if (!(position.y == position.y)) return {position.y, position.y};
    lowest = std::min(lowest, position.y);
    highest = std::max(highest, position.y);
  }
  return {lowest, highest};
}

void add_at_most(const char* check, std::optional<double> limit, double measured, const char* unit,
                 std::vector<Verdict>& verdicts) {
  if (limit) verdicts.push_back({check, measured, *limit, false, unit, measured <= *limit});
}

void add_at_least(const char* check, std::optional<double> limit, double measured, const char* unit,
                  std::vector<Verdict>& verdicts) {
  if (limit) verdicts.push_back({check, measured, *limit, true, unit, measured >= *limit});
}

}  // namespace

double expect_time_s(const Scene& scene, double run_s) {
  return scene.expect ? scene.expect->at_time_s.value_or(run_s) : run_s;
}

std::vector<Verdict> check_expectations(const Model& model, const State& state) {
  std::vector<Verdict> verdicts;
  if (!model.scene.expect) return verdicts;
  const ExpectSection& expect = *model.scene.expect;
  const Stretch stretched = stretch(model, state);
  const auto [lowest_m, highest_m] = heights(state);
  add_at_most("max_stretch", expect.max_stretch, stretched.maximum, "", verdicts);
  add_at_most("p99_stretch", expect.p99_stretch, stretched.p99, "", verdicts);
  add_at_least("lowest_y", expect.lowest_y_m, lowest_m, "m", verdicts);
  add_at_most("highest_y", expect.highest_y_m, highest_m, "m", verdicts);
  add_at_most("energy_max_j", expect.energy_max_j, energy(model, state).total(), "J", verdicts);
  return verdicts;
}

std::vector<Verdict> run_expectations(Simulation& simulation, double run_s) {
  const double until_s = expect_time_s(simulation.model().scene, run_s);
  run_for(simulation, until_s, [](std::uint64_t, std::uint64_t, const FrameStats&) { return true; });
  return check_expectations(simulation.model(), simulation.read());
}

bool all_hold(const std::vector<Verdict>& verdicts) {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.holds; });
}

std::string describe(const std::vector<Verdict>& verdicts) {
  std::string text;
  for (const Verdict& v : verdicts)
    text +=
        fmt::format("expect.{}: {:.6g}{}{} {} {:.6g}: {}\n", v.check, v.measured, v.unit.empty() ? "" : " ",
                    v.unit, v.at_least ? ">=" : "<=", v.limit, v.holds ? "holds" : "BROKEN");
  return text;
}

}  // namespace weft
