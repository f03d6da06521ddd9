// Measures the final state and prints it in the format asked for.
#include "cli/summary.h"

#include <fmt/format.h>

#include "cli/table.h"
#include "core/text.h"
#include "model/measures.h"

namespace weft::cli {
namespace {

std::string human_line(const Scene& scene, const nlohmann::ordered_json& s, const std::string& tail) {
  const std::string name = scene.title.empty() ? scene.source : scene.title;
  const std::string device = s["device"];
  // A software device's own label says so already.
  const bool says_so = device.find("(software)") != std::string::npos;
  const char* const no_gpu = s["software"].get<bool>() && !says_so ? " · no GPU" : "";
  return fmt::format(
      "{} · {}{} · {} · {} · {} · simulated {:.6g} s · wall {:.3g} s · real-time factor {:.3g} · "
      "max stretch {:.3g} % · hash {}{}\n",
      name, device, no_gpu, s["solver"].get<std::string>(), s["precision"].get<std::string>(),
      counted(s["substeps"].get<std::uint32_t>(), "substep"), s["time_s"].get<double>(),
      s["wall_s"].get<double>(), s["real_time_factor"].get<double>(), 100.0 * s["max_stretch"].get<double>(),
      s["hash"].get<std::string>(), tail);
}

}  // namespace

nlohmann::ordered_json summarize(const Setup& setup, const Machine& machine, const Outcome& outcome) {
  const Stretch stretched = stretch(setup.model, outcome.state);
  const double time_s = outcome.state.time_s;
  return {{"device", machine.device_label()},
          {"software", machine.on_software()},
          {"solver", std::string(setup.solver->name)},
          {"precision", setup.scene().solver.precision},
          {"substeps", machine.simulation->plan().substeps},
          {"time_s", time_s},
          {"wall_s", outcome.wall_s},
          {"spring_evaluations", outcome.spring_evaluations},
          {"real_time_factor", outcome.wall_s > 0.0 ? time_s / outcome.wall_s : 0.0},
          {"max_stretch", stretched.maximum},
          {"p99_stretch", stretched.p99},
          {"energy_j", energy(setup.model, outcome.state).total()},
          {"hash", fmt::format("{:016x}", state_hash(outcome.state))}};
}

void print_summary(const Options& o, const Scene& scene, const nlohmann::ordered_json& fields,
                   const std::string& tail) {
  if (o.format == Format::human) return print_result(human_line(scene, fields, tail));
  if (o.format == Format::json) return print_result(fields.dump(2) + '\n');
  Table table;
  table.rows.emplace_back();
  for (const auto& [key, value] : fields.items()) {
    table.columns.push_back(key);
    table.rows[0].push_back(value);
  }
  print_result(to_text(table, Format::csv));
}

}  // namespace weft::cli
