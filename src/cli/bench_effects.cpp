// What each effect costs, as one table: milliseconds, bytes and dispatches with it and without it.
#include "cli/bench_effects.h"

#include <cmath>

#include "cli/setup.h"
#include "cli/table.h"
#include "sim/effect_bench.h"
#include "sim/native_simulation.h"
#include "solvers/solver.h"

namespace weft::cli {
namespace {

constexpr std::uint32_t kEffectTurns = 9;
/// Native gets through more in the same time: EffectBenchOptions::turn_most and warm_most.
constexpr double kNativeTurnMost = 2e7, kNativeWarmMost = 1e9;

/// Null where nobody measured it.
nlohmann::ordered_json number_or_null(double value) {
  if (std::isnan(value)) return nullptr;
  return value;
}

Table effect_table(const EffectBenchReport& report) {
  Table table{{"scene",
               "effect",
               "state",
               "ms_with",
               "ms_without",
               "cost_percent",
               "spread_percent",
               "processor_ms_with",
               "processor_ms_without",
               "processor_cost_percent",
               "absent_percent",
               "bytes_with",
               "bytes_without",
               "dispatches_with",
               "dispatches_without",
               "substeps_with",
               "substeps_without",
               "toggle_ms",
               "kernel_with",
               "kernel_without"},
              {}};
  for (const EffectRow& row : report.rows) {
    if (!row.left_out.empty()) continue;
    table.rows.push_back({report.scene,
                          row.effect,
                          row.in_scene ? "at work" : "idle",
                          row.with.frame_ms.median,
                          row.without.frame_ms.median,
                          100 * row.cost,
                          100 * row.cost_spread,
                          number_or_null(row.with.processor_ms.median),
                          number_or_null(row.without.processor_ms.median),
                          number_or_null(100 * row.processor_cost),
                          number_or_null(100 * row.absent_cost),
                          row.with.bytes,
                          row.without.bytes,
                          row.with.dispatches,
                          row.without.dispatches,
                          row.with.automatic,
                          row.without.automatic,
                          row.toggle_ms,
                          row.with.kernel,
                          row.without.kernel});
  }
  return table;
}

std::string describe(const EffectBenchReport& report, const std::string& device) {
  std::string text = fmt::format("{} · {}x{} · {} · {} {} · median of {} turns each, after {:.3g} s\n{}",
                                 report.scene, report.nx, report.ny, device, report.solver, report.precision,
                                 kEffectTurns, report.time_s, to_text(effect_table(report), Format::human));
  for (const EffectRow& row : report.rows)
    if (!row.left_out.empty()) text += fmt::format("{}: not measured, {}\n", row.effect, row.left_out);
  return text;
}

/// Where it runs: what was named, else native where that is the default and runs every scene.
Options effect_device(const Options& asked, const std::vector<Scene>& scenes) {
  const Options settled = with_default_device(asked);
  if (!asked.device.empty() || !settled.on_native()) return asked;
  for (const Scene& scene : scenes)
    if (!native_lacks(build_model(scene), find_solver(scene.solver.name), scene.solver.precision).empty())
      return asked;
  note(asked,
       "no GPU is used: the best Vulkan device is a software one; native is measured, by the wall clock and "
       "by processor time. For the Vulkan device name it by --device");
  return settled;
}

EffectBenchReport report_of(const Options& o, gpu::Device* device, const Scene& scene) {
  EffectBenchOptions options;
  if (o.time_s) options.time_s = *o.time_s;
  options.only = o.only_effects;
  options.kernel = o.kernel;
  options.repetitions = kEffectTurns;
  const auto told = [&](const std::string& effect) { note(o, fmt::format("timing {}", effect)); };
  if (device != nullptr) return bench_effects(*device, scene, options, told);
  options.turn_most = kNativeTurnMost;
  options.warm_most = kNativeWarmMost;
  return bench_effects_on_native(scene, options, told);
}

}  // namespace

Exit run_effect_bench(const Options& asked) {
  const std::vector<Scene> scenes = scenes_to_time(asked);
  const Options o = effect_device(asked, scenes);
  refuse_vulkan_options(o, false);
  const std::unique_ptr<gpu::Device> device = o.on_vulkan() ? open_device(o) : nullptr;
  Table all;
  for (const Scene& scene : scenes) {
    const EffectBenchReport report = report_of(o, device.get(), scene);
    if (o.format == Format::human)
      print_result(describe(report, device ? device_label(device->info()) : report.device));
    Table one = effect_table(report);
    all.columns = one.columns;
    for (auto& row : one.rows) all.rows.push_back(std::move(row));
  }
  if (o.format != Format::human) print_result(to_text(all, o.format));
  report_validation(device.get());
  return Exit::ok;
}

}  // namespace weft::cli
