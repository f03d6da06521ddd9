// `weft plan`: what a scene would run, over which ranges, in which buffers, and what is left out.
#include "plan/plan.h"

#include "cli/choose.h"
#include "cli/command.h"
#include "cli/setup.h"
#include "cli/table.h"

namespace weft::cli {
namespace {

std::string steps_as_csv(const Plan& plan) {
  Table table{{"pass", "repeat", "range_x", "range_y", "constants"}, {}};
  for (const PlanStep& step : plan.steps) {
    std::string constants;
    for (const Constant& constant : step.constants)
      constants += fmt::format("{}{}={}", constants.empty() ? "" : " ", constant.name, constant.value);
    table.rows.push_back({std::string(step.pass->name), step.repeat, step.range.x, step.range.y, constants});
  }
  return to_text(table, Format::csv);
}

Exit run_plan(const Options& asked) {
  const std::string& name = only_scene(asked);
  const Options o = with_chosen_setting(asked, name, [&](const Scene&) { return asked.time_or_default_s(); });
  const Setup setup = set_up(o, name);
  const Plan compiled = compile_plan(setup.model, *setup.solver, setup.scene().solver.precision);
  std::string text;
  switch (o.format) {
    case Format::human: text = describe(compiled, setup.model); break;
    case Format::json: text = to_json(compiled, setup.model); break;
    case Format::csv: text = steps_as_csv(compiled); break;
  }
  if (text.empty() || text.back() != '\n') text += '\n';
  print_result(text);
  return Exit::ok;
}

void add_plan_options(CLI::App& app, Options& o) {
  add_scene(app, o);
  add_choice_options(app, o);
}

}  // namespace

const Command plan_command{
    "plan",
    "prints the passes, constants, ranges and buffers of a scene, and what is left out",
    "  weft plan 1\n  weft plan 5 --resolution 256 --format json",
    add_plan_options,
    run_plan,
    false};

}  // namespace weft::cli
