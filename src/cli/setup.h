// From options to something that runs: the scene with its overrides, the model, the solver, the device.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "cli/options.h"
#include "gpu/device.h"
#include "model/model.h"
#include "scene/reader.h"
#include "sim/gpu_simulation.h"
#include "sim/host_simulation.h"
#include "sim/simulation.h"
#include "solvers/solver.h"

namespace weft::cli {

/// A scene made ready: read, overridden, checked, built.
struct Setup {
  Model model;
  const Solver* solver = nullptr;
  const Scene& scene() const { return model.scene; }
};

/// A running cloth and, unless it runs on the CPU, the device below it.
struct Machine {
  std::unique_ptr<gpu::Device> device;  ///< null on the CPU; outlives the simulation
  std::unique_ptr<Simulation> simulation;
  GpuSimulation* on_gpu = nullptr;      ///< the simulation, unless it runs on the CPU
  HostSimulation* on_native = nullptr;  ///< the simulation, when native was asked for or is the default
  DrawnSimulation* drawn = nullptr;     ///< the simulation, when it writes what is drawn (draw_with)
  /// As summaries name it; software devices say so.
  std::string device_label() const;
  /// Whether no GPU computes.
  bool on_software() const;
};

/// `--set` first, then the options that stand for one key each.
SceneOverrides overrides_of(const Options&);

/// Reads a scene and says its warnings on stderr (not with `--quiet`).
/// @throws Error(Exit::usage)
Scene open_scene(const Options&, const std::string& number_name_or_path);

/// open_scene, then the model and the solver, with the precision checked against the device asked for.
/// @throws Error(Exit::usage)
Setup set_up(const Options&, const std::string& number_name_or_path);

/// The scenes of a bench: those that were named, else scene 1.
/// @throws Error(Exit::usage)
std::vector<Scene> scenes_to_time(const Options&);

/// The options with `--device native` where no device is named and native is the default: the best Vulkan
/// device is a software one, and no option speaks of Vulkan (--kernel, --shaders, --validation,
/// --force-staging).
Options with_default_device(const Options&);

/// For commands that open no device: --device must be one all the same.
/// @throws Error(Exit::no_device) listing those there are
void require_known_device(const Options&);

/// Refuses options that speak of Vulkan together with a device that runs none.
/// @param draws  whether a Vulkan device draws what is computed; then only the kernel is nobody's
/// @throws Error(Exit::usage) naming both
void refuse_vulkan_options(const Options&, bool draws);

/// What the options say of the device.
gpu::DeviceOptions device_options(const Options&);

/// The device asked for.
/// @throws Error(Exit::no_device) when there is no such device; there is no silent fallback
std::unique_ptr<gpu::Device> open_device(const Options&);

/// "llvmpipe (software)": a device's name, and plainly said when it is no GPU.
std::string device_label(const gpu::DeviceInfo&);

/// Builds the simulation on the CPU or on a Vulkan device. What native lacks runs, where it is the default,
/// on the Vulkan device, and else on the reference; a line on stderr says so.
/// @param run_s  simulated time that it will run: a long one is worth a trial of the kernels
Machine start(const Options&, const Setup&, double run_s);

/// Lets a Vulkan device draw the machine's simulation; native then writes into that device's vertex buffers.
void draw_with(std::unique_ptr<gpu::Device> device, Machine&);

/// Prints validation messages on stderr.
/// @throws Error(Exit::internal) when there is any: it is a mistake in Weft
void report_validation(const gpu::Device*);

/// A line on stderr, unless `--quiet`.
void note(const Options&, const std::string& text);

}  // namespace weft::cli
