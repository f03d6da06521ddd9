// `weft validate`: the device against the CPU reference, pass by pass and in lockstep, as one table.
#include "sim/validate.h"

#include "cli/choose.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "cli/setup.h"
#include "cli/study_watch.h"
#include "cli/table.h"
#include "core/text.h"
#include "sim/native_validate.h"
#include "sim/perturb.h"

namespace weft::cli {
namespace {

Table table_of(const std::vector<ValidationReport>& reports) {
  Table table{{"scene", "check", "state", "buffer", "max_abs", "rms", "bias", "max_ulp", "tolerance", "ok",
               "verdict"},
              {}};
  for (const ValidationReport& report : reports)
    for (const ValidationRow& row : report.rows)
      table.rows.push_back({report.scene, row.check, row.state, row.buffer, row.max_abs, row.rms, row.bias,
                            row.max_ulp, row.tolerance, row.ok, row.verdict});
  return table;
}

/// How many comparisons there were, and how many of them failed.
struct Count {
  std::size_t rows = 0, broken = 0;
};

Count count(const std::vector<ValidationReport>& reports) {
  Count total;
  for (const ValidationReport& report : reports)
    for (const ValidationRow& row : report.rows) {
      ++total.rows;
      if (!row.ok) ++total.broken;
    }
  return total;
}

std::string json_of(const std::vector<ValidationReport>& reports, const std::string& device, bool ok) {
  const ValidationReport& first = reports.front();
  nlohmann::ordered_json whole{{"device", device},
                               {"ok", ok},
                               {"exact_required", first.exact_required},
                               {"perturbed", first.perturbed}};
  whole["rows"] = nlohmann::ordered_json::parse(to_text(table_of(reports), Format::json));
  return whole.dump(2) + '\n';
}

void print_reports(const Options& o, const std::vector<ValidationReport>& reports, const std::string& device,
                   bool ok) {
  if (o.format == Format::json) return print_result(json_of(reports, device, ok));
  std::string text = to_text(table_of(reports), o.format);
  if (o.format == Format::human) {
    const Count total = count(reports);
    const ValidationReport& first = reports.front();
    text += fmt::format("{} · {}{} comparisons in {} scenes · {} over tolerance{}\n", device,
                        first.perturbed.empty() ? "" : first.perturbed + " falsified · ", total.rows,
                        reports.size(), total.broken,
                        first.exact_required ? " · this device must agree to the bit" : "");
  }
  print_result(text);
}

std::vector<std::string> scenes_asked_for(const Options& o) {
  if (!o.scenes.empty()) return o.scenes;
  std::vector<std::string> names;
  for (const AssetInfo& asset : numbered_scenes()) names.push_back(asset.name);
  return names;
}

/// A constant that no scene has on would falsify nothing, and the comparison would pass for the wrong reason.
/// @throws Error(Exit::usage)
void require_effect(const Options& o, const std::vector<Setup>& setups) {
  if (o.perturb.empty()) return;
  for (const Setup& setup : setups) {
    const Plan plan = compile_plan(setup.model, *setup.solver, setup.scene().solver.precision);
    if (Perturbation(o.perturb, plan).active()) return;
  }
  throw error(
      Exit::usage,
      "--perturb is {}; none of the scenes validated has that effect, so that nothing would be falsified "
      "(add a scene that has it, or leave the scenes away to validate all)",
      in_quotes(o.perturb));
}

Exit run_validate(const Options& o) {
  if (o.on_cpu())
    throw Error(
        Exit::usage,
        "validate: --device is cpu; it must be a Vulkan device or native (the CPU reference is what it is "
        "compared with); see `weft devices`");
  refuse_vulkan_options(o, false);
  const std::vector<std::string> names = scenes_asked_for(o);
  std::vector<Setup> setups;
  for (const std::string& name : names)
    setups.push_back(
        set_up(with_chosen_setting(o, name, [&](const Scene&) { return o.time_or_default_s(); }), name));
  require_effect(o, setups);
  const std::unique_ptr<gpu::Device> device = o.on_native() ? nullptr : open_device(o);
  const ValidationOptions options{.perturb = o.perturb};
  std::vector<ValidationReport> reports;
  bool ok = true;
  {
    Progress progress("validating", o.quiet);
    for (const Setup& setup : setups) {
      reports.push_back(device ? weft::validate(*device, setup.model, *setup.solver, options)
                               : validate_native(setup.model, *setup.solver, options));
      ok = ok && reports.back().ok();
      progress.show(reports.size(), setups.size());
    }
  }
  const std::string label = device ? device_label(device->info()) : study_bench(o, nullptr).label;
  print_reports(o, reports, label, ok);
  report_validation(device.get());
  return ok ? Exit::ok : Exit::tolerance;
}

void add_validate_options(CLI::App& app, Options& o) {
  add_scenes(app, o);
  add_choice_options(app, o);
  app.add_option_function<std::string>(
         "--perturb",
         [&o](const std::string& text) {
           if (text.empty())
             throw Error(
                 Exit::usage,
                 "--perturb is empty; it must be PASS.CONSTANT (for example --perturb integrate.gravity)");
           o.perturb = text;
         },
         "falsify one constant of one pass on the device, to see this fail")
      ->type_name("PASS.CONSTANT");
}

}  // namespace

const Command validate_command{"validate",
                               "compares the device with the CPU reference; exit 5 when over tolerance",
                               "  weft validate\n"
                               "  weft validate --device native\n"
                               "  weft validate 1 5 --format csv\n"
                               "  weft validate 1 --perturb integrate.gravity     (must exit 5)",
                               add_validate_options, run_validate};

}  // namespace weft::cli
