// Turns options into scenes, models, devices and simulations; every command begins here.
#include "cli/setup.h"

#include <iostream>

#include "cli/text.h"
#include "core/error.h"
#include "gpu/log.h"
#include "gpu/shader.h"
#include "sim/native_simulation.h"

namespace weft::cli {
namespace {

void require_device_solver(const Options& o, const Scene& scene, const Solver& solver) {
  if (!o.on_vulkan() || solver.on_gpu) return;
  throw error(Exit::usage, "{}: solver {} runs on the CPU reference only; run it with --device cpu",
              scene.source, solver.name);
}

void note_what_native_lacks(const Options& o, const Setup& setup) {
  const std::string lacks = native_lacks(setup.model, *setup.solver, setup.scene().solver.precision);
  if (!lacks.empty()) note(o, lacks + ", so that the CPU reference runs this");
}

}  // namespace

SceneOverrides overrides_of(const Options& o) {
  SceneOverrides overrides{o.set};
  auto& set = overrides.set;
  if (o.resolution) set.push_back(fmt::format("cloth.resolution={}", *o.resolution));
  if (o.material) set.push_back("material.preset=" + toml_string(*o.material));
  if (o.solver) set.push_back("solver.name=" + toml_string(*o.solver));
  if (o.substeps)
    set.push_back(*o.substeps == 0 ? "solver.substeps=\"auto\""
                                   : fmt::format("solver.substeps={}", *o.substeps));
  if (o.precision) set.push_back("solver.precision=" + toml_string(*o.precision));
  if (o.frame_s) set.push_back(fmt::format("solver.frame={:.17g}", *o.frame_s));
  return overrides;
}

Scene open_scene(const Options& o, const std::string& number_name_or_path) {
  LoadedScene loaded = load_scene(find_scene(number_name_or_path), overrides_of(o));
  for (const std::string& warning : loaded.warnings) note(o, "warning: " + warning);
  return std::move(loaded.scene);
}

Setup set_up(const Options& o, const std::string& number_name_or_path) {
  const Scene scene = open_scene(o, number_name_or_path);
  Setup setup{build_model(scene), &find_solver(scene.solver.name)};
  require_device_solver(o, scene, *setup.solver);
  return setup;
}

gpu::DeviceOptions device_options(const Options& o) {
  gpu::DeviceOptions wanted;
  wanted.choice = o.device;
  wanted.validation = o.validation;
  wanted.force_staging = o.force_staging;
  return wanted;
}

std::unique_ptr<gpu::Device> open_device(const Options& o) {
  gpu::set_quiet(o.quiet);
  gpu::set_shader_dir(o.shaders);
  return std::make_unique<gpu::Device>(device_options(o));
}

std::string device_label(const gpu::DeviceInfo& info) { return info.label(); }

Machine start(const Options& o, const Setup& setup, double run_s) {
  Machine machine;
  const std::string& precision = setup.scene().solver.precision;
  if (!o.on_vulkan()) {
    machine.simulation = o.on_cpu() ? make_cpu_simulation(setup.model, *setup.solver, precision)
                                    : make_native_simulation(setup.model, *setup.solver, precision);
    if (o.on_native()) note_what_native_lacks(o, setup);
    machine.device_label = machine.simulation->device_name();
    return machine;
  }
  machine.device = open_device(o);
  const Plan planned = compile_plan(setup.model, *setup.solver, setup.scene().solver.precision);
  const double substeps = run_s / setup.scene().solver.frame_s * planned.substeps;
  const bool long_run = expected_work_s(*machine.device, planned, substeps) >= kWorthTrying_s;
  auto on_gpu = GpuSimulation::create(
      *machine.device, setup.model, *setup.solver,
      {.kernel = o.kernel, .trial = long_run ? KernelTrial::allowed : KernelTrial::when_named});
  machine.on_gpu = on_gpu.get();
  machine.simulation = std::move(on_gpu);
  machine.device_label = device_label(machine.device->info());
  return machine;
}

void report_validation(const gpu::Device* device) {
  if (device == nullptr || device->validation_messages().empty()) return;
  for (const std::string& message : device->validation_messages()) std::cerr << message << '\n';
  throw error(Exit::internal,
              "the validation layer gave {} messages; this is a bug of Weft, please report it",
              device->validation_messages().size());
}

void note(const Options& o, const std::string& text) {
  if (!o.quiet) std::cerr << "weft: " << text << '\n';
}

}  // namespace weft::cli
