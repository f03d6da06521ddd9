// The bench report in the shape of Google Benchmark's JSON, so that its tools compare two runs.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "core/cores.h"
#include "sim/bench.h"

namespace weft {
namespace {

using BenchJson = nlohmann::ordered_json;

void add(BenchJson& list, const std::string& name, const std::string& aggregate, std::uint32_t repetitions,
         double ns, const BenchJson& counters) {
  BenchJson entry = {{"name", name + "_" + aggregate},
                     {"run_name", name},
                     {"run_type", "aggregate"},
                     {"repetitions", repetitions},
                     {"threads", 1},
                     {"aggregate_name", aggregate},
                     {"aggregate_unit", "time"},
                     {"iterations", repetitions},
                     {"real_time", ns},
                     {"cpu_time", ns},
                     {"time_unit", "ns"}};
  entry.update(counters);
  list.push_back(std::move(entry));
}

}  // namespace

std::string to_benchmark_json(const BenchReport& report) {
  BenchJson json;
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  json["context"] = {{"date", fmt::format("{:%FT%TZ}", fmt::gmtime(now))},
                     {"executable", "weft bench"},
                     {"num_cpus", usable_cores()},
                     {"device", report.device},
                     {"driver", report.driver},
                     {"scene", report.scene},
                     {"solver", report.solver},
                     {"precision", report.precision},
                     {"copy_moved_gb_per_s", report.copy.best_gb_s()},
                     {"copy_copied_gb_per_s", report.copy.best_gb_s() / 2},
                     {"copy_best", report.copy.best()},
                     {"copy_command_moved_gb_per_s", report.copy.command_gb_s.median},
                     {"copy_shader_moved_gb_per_s", report.copy.shader_gb_s.median},
                     {"copy_buffer_bytes", report.copy.buffer_bytes}};
  json["benchmarks"] = BenchJson::array();
  for (const BenchRow& row : report.rows)
    for (const BenchPass& pass : row.passes) {
      const std::string name =
          fmt::format("{}/{}x{}/{}", pass.pass, row.nx, row.ny, row.damping ? "damped" : "undamped");
      BenchJson counters = {{"ms_spread", pass.ms.spread}, {"bytes", row.bytes}, {"kernel", row.kernel}};
      if (pass.pass == row.passes[0].pass) {
        counters["ns_per_particle_substep"] = row.ns_per_particle_substep.median;
        counters["items_per_second"] = row.particle_substeps_per_s;
        counters["bytes_per_second"] = row.gb_s * 1e9;
        counters["share_moved"] = row.share_moved;
        counters["share_copied"] = row.share_copied;
        counters["substeps"] = row.substeps;
      }
      add(json["benchmarks"], name, "median", report.repetitions, pass.ms.median * 1e6, counters);
      add(json["benchmarks"], name, "half_iqr", report.repetitions, pass.ms.spread * 1e6,
          BenchJson::object());
    }
  return json.dump(2);
}

}  // namespace weft
