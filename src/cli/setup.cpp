// Turns options into scenes, models, devices and simulations; every command begins here.
#include "cli/setup.h"

#include <cstdlib>
#include <iostream>
#include <utility>

#include "cli/text.h"
#include "core/error.h"
#include "gpu/log.h"
#include "gpu/shader.h"
#include "sim/host_drawn.h"
#include "sim/native_simulation.h"

namespace weft::cli {
namespace {

void require_device_solver(const Options& o, const Scene& scene, const Solver& solver) {
  if (!o.on_vulkan() || solver.on_gpu) return;
  throw error(Exit::usage, "{}: solver {} runs on the CPU reference only; run it with --device cpu",
              place_of(scene, "solver.name"), solver.name);
}

/// Where it runs, once native was asked for or is the default.
Options settled_device(const Options& asked, const Setup& setup) {
  Options o = with_default_device(asked);
  if (!o.on_native()) return o;
  const std::string lacks = native_lacks(setup.model, *setup.solver, setup.scene().solver.precision);
  if (!lacks.empty())
    note(o, fmt::format("{}, so that the CPU reference runs this", lacks));
  else if (asked.device.empty())
    note(o,
         "no GPU is used: the best Vulkan device is a software one, and native computes on the CPU itself");
  return o;
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
  if (!setup.solver->instability.empty())
    note(o, fmt::format("warning: {}: solver.name is {}, which {} (leapfrog does not)",
                        place_of(scene, "solver.name"), setup.solver->name, setup.solver->instability));
  require_device_solver(o, scene, *setup.solver);
  return setup;
}

std::vector<Scene> scenes_to_time(const Options& o) {
  std::vector<Scene> scenes;
  for (const std::string& name : o.scenes.empty() ? std::vector<std::string>{"1"} : o.scenes)
    scenes.push_back(set_up(o, name).model.scene);
  return scenes;
}

void refuse_vulkan_options(const Options& o, bool draws) {
  if (o.on_vulkan()) return;
  const std::pair<const char*, bool> only_vulkan[] = {{"--kernel", !o.kernel.empty()},
                                                      {"--shaders", !o.shaders.empty() && !draws},
                                                      {"--validation", o.validation && !draws},
                                                      {"--force-staging", o.force_staging && !draws}};
  for (const auto& [option, given] : only_vulkan)
    if (given)
      throw error(
          Exit::usage,
          "{} and --device {} are both given; {} is for what a Vulkan device computes, so leave one of "
          "them out, or name such a device (`weft devices` lists them)",
          option, o.device, option);
}

void require_known_device(const Options& o) {
  if (!o.device.empty() && o.on_vulkan()) gpu::require_device(o.device);
}

Options with_default_device(const Options& o) {
  const bool speaks_of_vulkan = !o.device.empty() || !o.kernel.empty() || !o.shaders.empty() ||
                                o.validation || o.force_staging || std::getenv("WEFT_KERNEL") != nullptr;
  if (speaks_of_vulkan || !native_by_default(gpu::list_devices())) return o;
  Options native = o;
  native.device = "native";
  return native;
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

Machine start(const Options& asked, const Setup& setup, double run_s) {
  const Options o = settled_device(asked, setup);
  Machine machine;
  const std::string& precision = setup.scene().solver.precision;
  if (o.on_cpu()) {
    machine.simulation = make_cpu_simulation(setup.model, *setup.solver, precision);
    return machine;
  }
  if (o.on_native()) {
    auto native = make_native_simulation(setup.model, *setup.solver, precision);
    machine.on_native = native.get();
    machine.simulation = std::move(native);
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
  machine.drawn = on_gpu.get();
  machine.simulation = std::move(on_gpu);
  return machine;
}

std::string Machine::device_label() const {
  return on_gpu != nullptr ? device->info().label() : simulation->device_name();
}

bool Machine::on_software() const { return on_gpu == nullptr || device->info().software; }

void draw_with(std::unique_ptr<gpu::Device> device, Machine& machine) {
  machine.device = std::move(device);
  if (machine.on_native == nullptr) return;
  machine.simulation.release();
  std::unique_ptr<HostSimulation> native(std::exchange(machine.on_native, nullptr));
  auto drawn = draw_host_simulation(*machine.device, std::move(native));
  machine.drawn = drawn.get();
  machine.simulation = std::move(drawn);
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
