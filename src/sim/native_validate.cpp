// Whole runs rather than single passes: the kernels have no state between substeps but the cloth's own.
#include "sim/native_validate.h"

#include <algorithm>
#include <array>

#include "core/error.h"
#include "native/features.h"
#include "passes/tables.h"
#include "sim/compare.h"
#include "sim/native_simulation.h"
#include "sim/probe_states.h"

namespace weft {
namespace {

constexpr std::uint32_t kSeveralThreads = 3;  // so that one band has two neighbours

/// Position, velocity and normal after the run.
using Ending = HostBuffers<float>;
constexpr std::array kCompared{BufferId::position, BufferId::velocity, BufferId::normal};

/// The same frame for everybody.
struct NativeFrame {
  double length_s;
  std::uint32_t substeps;
};

Ending ending_of(HostSimulation& simulation, const State& from, const NativeFrame& frame) {
  simulation.write(from);
  simulation.advance(frame.length_s, frame.substeps);
  Ending ending;
  load_state(simulation.model(), simulation.read(), ending);
  ending[BufferId::normal].assign(simulation.model().grid.count(), glm::vec4(0.0f));
  std::vector<glm::vec4> positions(simulation.model().grid.count());
  simulation.write_drawn({&positions.data()->x, &ending[BufferId::normal].data()->x});
  return ending;
}

ValidationRow native_row(const std::string& kernel, const std::string& state, BufferId id, const Ending& got,
                         const Ending& expected) {
  const Difference apart = difference(std::span(got[id]), std::span(expected[id]));
  ValidationRow row{.check = kernel, .state = state, .buffer = std::string(row_of(id).name)};
  row.max_abs = apart.max_abs;
  row.rms = apart.rms;
  row.max_ulp = apart.max_ulp;
  row.bias = apart.bias;
  row.ok = apart.finite && apart.max_ulp == 0;
  row.verdict = !apart.finite ? "not finite" : row.ok ? "exact" : "over tolerance";
  return row;
}

void require_native(const Model& model, const Solver& solver, const ValidationOptions& options) {
  if (!options.perturb.empty())
    throw Error(Exit::usage,
                "--perturb falsifies a constant of a Vulkan device's pass and --device is native; name a "
                "Vulkan device (weft devices)");
  const std::string lacks = native_lacks(model, solver, model.scene.solver.precision);
  if (lacks.empty()) return;
  throw error(
      Exit::usage,
      "{}: {}, so that there is nothing to compare with the reference; validate it on a Vulkan device",
      model.scene.source, lacks);
}

}  // namespace

ValidationReport validate_native(const Model& model, const Solver& solver, const ValidationOptions& options) {
  require_native(model, solver, options);
  const Plan plan = compile_plan(model, solver, "f32");
  const std::uint32_t substeps = std::min(plan.substeps, options.lockstep_substeps);
  const NativeFrame frame{model.scene.solver.frame_s * substeps / plan.substeps, substeps};
  ValidationReport report{.device = "native", .scene = model.scene.title, .exact_required = true};
  for (const ProbeState& probe : probe_states(model, solver)) {
    const Ending expected = ending_of(*make_host_reference(model, solver, "f32"), probe.state, frame);
    for (const native::Kernels* kernels : native::kernels_here())
      for (const std::uint32_t threads : {1u, kSeveralThreads}) {
        const auto native =
            make_native_simulation(model, solver, "f32", {.threads = threads, .vector = kernels->name});
        const Ending got = ending_of(*native, probe.state, frame);
        const std::string kernel = fmt::format("{} substeps, {}", substeps, native->device_name());
        for (const BufferId id : kCompared)
          report.rows.push_back(native_row(kernel, probe.name, id, got, expected));
      }
  }
  return report;
}

}  // namespace weft
