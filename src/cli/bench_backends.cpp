// Every backend's wall time as one table; the Vulkan device takes part where there is one.
#include "cli/bench_backends.h"

#include "cli/setup.h"
#include "cli/table.h"
#include "sim/backend_bench.h"

namespace weft::cli {
namespace {

using Json = nlohmann::ordered_json;

/// A cell is null where its row has no such number.
Table backend_table(const BackendBenchReport& report) {
  Table table{{"scene", "resolution", "backend", "kernel", "threads_most", "cores", "substeps",
               "ns_per_particle_substep", "ns_median", "frame_ms", "divider_share", "divider_ns"},
              {}};
  for (const BackendRow& row : report.rows)
    table.rows.push_back({report.scene, fmt::format("{}x{}", row.nx, row.ny), row.backend,
                          row.kernel.empty() ? Json() : Json(row.kernel),
                          row.threads > 0 ? Json(row.threads) : Json(), row.beside_busy ? "busy" : "free",
                          row.substeps, row.ns_best, row.ns_median, row.frame_ms,
                          row.divider_share ? Json(*row.divider_share) : Json(),
                          row.divider_share ? Json(report.root_and_division_ns) : Json()});
  return table;
}

void refuse_all_kernels(const Options& o) {
  if (o.kernel != "all") return;
  throw Error(
      Exit::usage,
      "bench: --kernel is all and --device is native, which is timed beside one kernel of the Vulkan "
      "device; name that (`weft bench --device NAME --kernel all` says which is the fastest), or leave "
      "--kernel out");
}

/// The device that the comparison is with, or none.
std::unique_ptr<gpu::Device> device_beside(const Options& o) {
  Options vulkan = o;
  vulkan.device.clear();
  try {
    return open_device(vulkan);
  } catch (const Error& failure) {
    if (failure.code() != Exit::no_device) throw;
    note(o, "no Vulkan device can be used; native is compared with the reference alone");
    return nullptr;
  }
}

}  // namespace

Exit run_backend_bench(const Options& o) {
  refuse_all_kernels(o);
  const std::vector<Scene> wanted = scenes_to_time(o);
  const std::unique_ptr<gpu::Device> device = device_beside(o);
  BackendBenchOptions options;
  options.kernel = o.kernel;
  if (o.resolution) options.resolutions = {*o.resolution};
  Table all;
  for (const Scene& scene : wanted) {
    note(o, fmt::format("timing {}", scene.title.empty() ? scene.source : scene.title));
    const BackendBenchReport report = bench_backends(device.get(), scene, options);
    Table one = backend_table(report);
    if (o.format == Format::human)
      print_result(fmt::format(
          "{} · native beside {} and the CPU reference · {} cores · best and median of {} turns · root and "
          "division {:.3g} ns a float\n{}",
          report.scene, device ? device_label(device->info()) : "no Vulkan device", report.cores,
          report.repetitions, report.root_and_division_ns, to_text(one, Format::human)));
    all.columns = one.columns;
    for (auto& row : one.rows) all.rows.push_back(std::move(row));
  }
  if (o.format != Format::human) print_result(to_text(all, o.format));
  report_validation(device.get());
  return Exit::ok;
}

}  // namespace weft::cli
