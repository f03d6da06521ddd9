// What each effect costs, as one table: milliseconds, bytes and dispatches with it and without it.
#include "cli/bench_effects.h"

#include <cmath>

#include "cli/setup.h"
#include "cli/table.h"
#include "sim/effect_bench.h"

namespace weft::cli {
namespace {

/// Of an effect that is off, over a build without it; nothing where no such build is there.
nlohmann::ordered_json absent_percent(const EffectRow& row) {
  if (std::isnan(row.absent_cost)) return nullptr;
  return 100 * row.absent_cost;
}

Table effect_table(const EffectBenchReport& report) {
  Table table{{"scene", "effect", "state", "ms_with", "ms_without", "cost_percent", "spread_percent",
               "absent_percent", "bytes_with", "bytes_without", "dispatches_with", "dispatches_without",
               "substeps_with", "substeps_without", "toggle_ms", "kernel_with", "kernel_without"},
              {}};
  for (const EffectRow& row : report.rows) {
    if (!row.left_out.empty()) continue;
    table.rows.push_back({report.scene, row.effect, row.in_scene ? "at work" : "idle",
                          row.with.frame_ms.median, row.without.frame_ms.median, 100 * row.cost,
                          100 * row.cost_spread, absent_percent(row), row.with.bytes, row.without.bytes,
                          row.with.dispatches, row.without.dispatches, row.with.automatic,
                          row.without.automatic, row.toggle_ms, row.with.kernel, row.without.kernel});
  }
  return table;
}

std::string describe(const EffectBenchReport& report, const std::string& device, std::uint32_t repetitions) {
  std::string text = fmt::format("{} · {}x{} · {} · {} {} · median of {} turns each, after {:.3g} s\n{}",
                                 report.scene, report.nx, report.ny, device, report.solver, report.precision,
                                 repetitions, report.time_s, to_text(effect_table(report), Format::human));
  for (const EffectRow& row : report.rows)
    if (!row.left_out.empty()) text += fmt::format("{}: not measured, {}\n", row.effect, row.left_out);
  return text;
}

}  // namespace

Exit run_effect_bench(const Options& o) {
  if (!o.on_vulkan())
    throw error(Exit::usage,
                "bench --effects: --device is {}; it must be a Vulkan device, whose timestamps are read (see "
                "`weft devices`)",
                o.device);
  const std::vector<Scene> scenes = scenes_to_time(o);
  const std::unique_ptr<gpu::Device> device = open_device(o);
  EffectBenchOptions options;
  if (o.time_s) options.time_s = *o.time_s;
  options.only = o.only_effects;
  options.kernel = o.kernel;
  Table all;
  for (const Scene& scene : scenes) {
    const EffectBenchReport report = bench_effects(*device, scene, options, [&](const std::string& effect) {
      note(o, fmt::format("timing {}", effect));
    });
    if (o.format == Format::human)
      print_result(describe(report, device_label(device->info()), options.repetitions));
    Table one = effect_table(report);
    all.columns = one.columns;
    for (auto& row : one.rows) all.rows.push_back(std::move(row));
  }
  if (o.format != Format::human) print_result(to_text(all, o.format));
  report_validation(device.get());
  return Exit::ok;
}

}  // namespace weft::cli
