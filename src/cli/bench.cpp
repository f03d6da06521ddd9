// `weft bench`: GPU time a particle·substep at several sizes, and the share of the copy bandwidth it reaches.
#include "sim/bench.h"

#include "cli/bench_backends.h"
#include "cli/bench_effects.h"
#include "cli/command.h"
#include "cli/setup.h"
#include "cli/table.h"

namespace weft::cli {
namespace {

double pass_ms(const BenchRow& row, std::string_view pass) {
  for (const BenchPass& timed : row.passes)
    if (timed.pass == pass) return timed.ms.median;
  return 0.0;
}

Table table_of(const BenchReport& report) {
  Table table{{"scene", "resolution", "damping", "substeps", "ns_per_particle_substep", "spread",
               "particle_substeps_per_s", "integrate_ms", "normals_ms", "gb_s", "share_moved", "share_copied",
               "bytes", "kernel"},
              {}};
  for (const BenchRow& row : report.rows)
    table.rows.push_back({report.scene, fmt::format("{}x{}", row.nx, row.ny), row.damping, row.substeps,
                          row.ns_per_particle_substep.median, row.ns_per_particle_substep.spread,
                          row.particle_substeps_per_s, pass_ms(row, "integrate"), pass_ms(row, "normals"),
                          row.gb_s, row.share_moved, row.share_copied, row.bytes, row.kernel});
  return table;
}

std::string describe(const BenchReport& report, const std::string& device) {
  return fmt::format(
      "{} · {} · {} {} · {} repetitions\ncopy: {:.3g} ± {:.2g} GB/s moved by command, {:.3g} ± {:.2g} "
      "by shader (read and written; half of it copied), {} MiB buffers\n{}",
      report.scene, device, report.solver, report.precision, report.repetitions,
      report.copy.command_gb_s.median, report.copy.command_gb_s.spread, report.copy.shader_gb_s.median,
      report.copy.shader_gb_s.spread, report.copy.buffer_bytes >> 20,
      to_text(table_of(report), Format::human));
}

/// One document: the first report's context, every report's benchmarks.
std::string json_of(const std::vector<BenchReport>& reports) {
  nlohmann::ordered_json whole;
  for (const BenchReport& report : reports) {
    nlohmann::ordered_json one = nlohmann::ordered_json::parse(to_benchmark_json(report));
    if (whole.is_null()) {
      whole = std::move(one);
      continue;
    }
    for (auto& benchmark : one["benchmarks"]) whole["benchmarks"].push_back(std::move(benchmark));
  }
  return whole.dump(2) + '\n';
}

std::string csv_of(const std::vector<BenchReport>& reports) {
  Table all;
  for (const BenchReport& report : reports) {
    Table one = table_of(report);
    all.columns = one.columns;
    for (auto& row : one.rows) all.rows.push_back(std::move(row));
  }
  return to_text(all, Format::csv);
}

Exit run_bench(const Options& o) {
  if (o.on_cpu())
    throw Error(Exit::usage,
                "bench: --device is cpu; it must be a Vulkan device, whose timestamps are read, or native, "
                "which is timed "
                "beside all others; see `weft devices`");
  if (o.effects) return run_effect_bench(o);
  if (o.on_native()) return run_backend_bench(o);
  const std::vector<Scene> scenes = scenes_to_time(o);
  const std::unique_ptr<gpu::Device> device = open_device(o);
  BenchOptions options;
  options.kernel = o.kernel;
  if (o.resolution) options.resolutions = {*o.resolution};
  std::vector<BenchReport> reports;
  for (const Scene& scene : scenes) {
    note(o, fmt::format("timing {}", scene.title.empty() ? scene.source : scene.title));
    reports.push_back(weft::bench(*device, scene, options));
    if (o.format == Format::human) print_result(describe(reports.back(), device_label(device->info())));
  }
  if (o.format == Format::json) print_result(json_of(reports));
  if (o.format == Format::csv) print_result(csv_of(reports));
  report_validation(device.get());
  return Exit::ok;
}

}  // namespace

const Command bench_command{"bench", "times the passes at 64 to 1024 particles a side (or at --resolution)",
                            "  weft bench\n"
                            "  weft bench 1 4 --resolution 256\n"
                            "  weft bench 1 --format json > bench.json\n"
                            "  weft bench 1 --device native      (all backends side by side)\n"
                            "  weft bench 5 --effects            (each effect with and without it)\n"
                            "  weft bench 1 --effects --device native",
                            add_bench_options, run_bench};

}  // namespace weft::cli
