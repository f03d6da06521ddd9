// What the device needs for a substep, in GPU time, against the bandwidth it copies with.
#include "sim/bench.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "core/error.h"
#include "gpu/commands.h"
#include "gpu/shader.h"
#include "passes/passes.h"
#include "sim/device_data.h"
#include "sim/gpu_program.h"
#include "sim/kernel_choice.h"

namespace weft {
namespace {

constexpr VkDeviceSize kCopyBytes = VkDeviceSize{128} << 20;  // larger than any cache
constexpr std::uint32_t kCopyRow = 4096;                      // vec4s a row of workgroups: 2-D, 1-D overflows
constexpr double kSubmitMs = 40;

Plan planned(const Model& model) {
  const SolverSection& wanted = model.scene.solver;
  return compile_plan(model, find_solver(wanted.name), wanted.precision);
}

/// Commands recorded once and timed by the device.
class Timed {
 public:
  Timed(gpu::Device& device, const std::string& name, const std::function<void(VkCommandBuffer)>& record)
      : device_(device), commands_(device, name, gpu::Reuse::many), timer_(device, 2) {
    commands_.record([&](VkCommandBuffer commands) {
      timer_.reset(commands);
      timer_.stamp(commands, 0);
      record(commands);
      timer_.stamp(commands, 1);
    });
  }
  double run_ms() {
    device_.wait(device_.submit(commands_.handle()));
    const double ms = timer_.between_ms(0, 1);
    if (ms < 0) throw error(Exit::no_device, "{} has no timestamps; bench needs them", device_.info().name);
    return ms;
  }

 private:
  gpu::Device& device_;
  gpu::Commands commands_;
  gpu::Timer timer_;
};

/// Two large buffers and two ways to copy one to the other.
class CopyBench {
 public:
  explicit CopyBench(gpu::Device& device)
      : bytes_(std::min<VkDeviceSize>(kCopyBytes, device.limits().maxStorageBufferRange / 65536 * 65536)),
        from_(device, "bench from", bytes_, kUsage, gpu::Memory::device),
        to_(device, "bench to", bytes_, kUsage, gpu::Memory::device),
        pipeline_(device, "copy", gpu::load_spirv("passes/copy.comp"), {}),
        set_(device, pipeline_, bound()),
        command_(device, "bench copy command",
                 [&](VkCommandBuffer commands) {
                   const VkBufferCopy whole{0, 0, bytes_};
                   vkCmdCopyBuffer(commands, from_.handle(), to_.handle(), 1, &whole);
                 }),
        shader_(device, "bench copy shader", [&](VkCommandBuffer commands) {
          gpu::Recorder recorder(device, commands);
          recorder.dispatch(pipeline_, set_, kCopyRow / pipeline_.reflection().local_size[0],
                            static_cast<std::uint32_t>((bytes_ / 16 + kCopyRow - 1) / kCopyRow));
        }) {
    const std::vector<std::byte> filled(bytes_, std::byte{1});  // never written pages would all be one page
    from_.write(filled);
    run();
    command_gb_s_.clear();
    shader_gb_s_.clear();
  }
  void run() {
    const double moved_gb = 2 * static_cast<double>(bytes_) * 1e-9;
    command_gb_s_.push_back(moved_gb / (command_.run_ms() * 1e-3));
    shader_gb_s_.push_back(moved_gb / (shader_.run_ms() * 1e-3));
  }
  CopyBandwidth result() const { return {sample_of(command_gb_s_), sample_of(shader_gb_s_), bytes_}; }

 private:
  static constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                               VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                               VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  std::vector<gpu::BoundBuffer> bound() const {
    return {{static_cast<std::uint32_t>(BufferId::position), &from_},
            {static_cast<std::uint32_t>(BufferId::position_next), &to_}};
  }
  VkDeviceSize bytes_;
  gpu::Buffer from_, to_;
  gpu::ComputePipeline pipeline_;
  gpu::DescriptorSet set_;
  Timed command_, shader_;
  std::vector<double> command_gb_s_, shader_gb_s_;
};

/// One size of the scene, with its plan's buffers and pipelines, timing each plan step by itself.
class SizeBench {
 public:
  SizeBench(gpu::Device& device, const Scene& scene, const BenchOptions& options, const std::string& kernel)
      : device_(device),
        model_(build_model(scene)),
        plan_(planned(model_)),
        choice_(choose_kernel(device, model_, plan_, nullptr, kernel)),
        buffers_(device, model_, plan_, choice_.kernel),
        program_(device, plan_, buffers_, nullptr, choice_.kernel) {
    fill();
    const double budget_ms = std::min(options.repetition_s * 1e3, kSubmitMs);
    for (std::size_t step = 0; step < plan_.steps.size(); ++step) {
      if (plan_.steps[step].block == Block::frame_end && program_.flips(step)) continue;  // as the substep's
      Timed few(device_, "bench warm-up", recording(step, 2));
      few.run_ms();  // compiles on some drivers
      const double one_ms = few.run_ms() / 2;
      const auto fits = static_cast<std::uint32_t>(std::clamp(budget_ms / one_ms, 2.0, 2000.0)) & ~1u;
      const auto runs = std::max(1.0, std::round(options.repetition_s * 1e3 / (fits * one_ms)));
      timings_.push_back({step,
                          at_once(step),
                          fits,
                          static_cast<std::uint32_t>(runs),
                          std::make_unique<Timed>(device_, "bench", recording(step, fits)),
                          {}});
    }
  }
  /// One repetition of every step, as often as fills the repetition's time.
  void run() {
    for (Timing& timing : timings_) {
      double ms = 0;
      for (std::uint32_t run = 0; run < timing.runs; ++run) ms += timing.commands->run_ms();
      timing.one_ms.push_back(ms / (double(timing.dispatches) * timing.runs));
    }
  }
  BenchRow result(double copy_gb_s) const;

 private:
  struct Timing {
    std::size_t step;
    std::uint32_t substeps;  ///< of one dispatch
    std::uint32_t dispatches, runs;
    std::unique_ptr<Timed> commands;
    std::vector<double> one_ms;
  };
  /// The start state and the rows of the first frame.
  void fill() {
    const auto rows = plan_.solver->schedule(0, model_.scene.solver.frame_s, plan_.substeps);
    write_blocks(buffers_, model_, plan_);
    buffers_.at(BufferId::substeps).write(table_bytes(model_, plan_, rows));
    write_state(buffers_, 0, model_, plan_, start_state(model_));
  }
  /// An even number of dispatches, so that the state ends where it began and the commands can run again.
  std::function<void(VkCommandBuffer)> recording(std::size_t step, std::uint32_t dispatches) {
    return [this, step, dispatches](VkCommandBuffer commands) {
      gpu::Recorder recorder(device_, commands);
      for (std::uint32_t d = 0; d < dispatches; ++d)
        program_.dispatch(recorder, step, program_.flips(step) ? d % 2 : 0, 0,
                          at_once(step) * d % (plan_.substeps - at_once(step) + 1), at_once(step));
    };
  }
  /// Substeps of one dispatch.
  std::uint32_t at_once(std::size_t step) const {
    return plan_.steps[step].block == Block::substep ? choice_.kernel.substeps : 1;
  }

  gpu::Device& device_;
  Model model_;
  Plan plan_;
  KernelChoice choice_;
  GpuBuffers buffers_;
  GpuProgram program_;
  std::vector<Timing> timings_;
};

BenchRow SizeBench::result(double copy_gb_s) const {
  BenchRow row;
  row.nx = model_.grid.nx;
  row.ny = model_.grid.ny;
  row.substeps = plan_.substeps;
  row.bytes = buffers_.bytes();
  row.kernel = describe(choice_);
  for (const Constant& constant : plan_.steps[0].constants)
    if (constant.name == "damping") row.damping = constant.value != 0;
  for (const Timing& timing : timings_) {
    const PlanStep& step = plan_.steps[timing.step];
    const Sample ms = sample_of(timing.one_ms);
    row.passes.push_back({std::string(step.pass->name), ms});
    row.passes.back().ms.median /= timing.substeps;
    row.passes.back().ms.spread /= timing.substeps;
    if (step.block != Block::substep) continue;
    row.dispatches = timing.dispatches * timing.runs;
    const double ns = 1e6 / model_.grid.count() / timing.substeps;
    row.ns_per_particle_substep.median += ms.median * ns;
    row.ns_per_particle_substep.spread += ms.spread * ns;
  }
  row.particle_substeps_per_s = 1e9 / row.ns_per_particle_substep.median;
  row.gb_s = bytes_per_particle_substep(plan_) / row.ns_per_particle_substep.median;
  row.share_moved = row.gb_s / copy_gb_s;
  row.share_copied = 2 * row.share_moved;
  return row;
}

std::vector<Scene> variants(const Scene& scene, const BenchOptions& options) {
  std::vector<Scene> scenes;
  for (const std::uint32_t resolution : options.resolutions)
    for (const bool damping : {true, false}) {
      Scene variant = scene;
      variant.cloth.resolution = resolution;
      variant.solver.substeps = 0;
      if (!damping) variant.material.damping_s = 0;
      if (damping ? scene.material.damping_s > 0 : options.without_damping || scene.material.damping_s == 0)
        scenes.push_back(std::move(variant));
    }
  return scenes;
}

/// The one asked for, or all kinds that fit.
std::vector<std::string> kernels_for(const gpu::Device& device, const Scene& scene,
                                     const BenchOptions& options) {
  if (options.kernel != "all") return {options.kernel};
  const Plan plan = planned(build_model(scene));
  return fitting_kernel_names(device, plan);
}

bool fits(gpu::Device& device, const Scene& scene) {
  const Model model = build_model(scene);
  try {
    require_fits(device, model, planned(model));
  } catch (const Error& refusal) {
    if (refusal.code() == Exit::no_device) return false;
    throw;
  }
  return true;
}

}  // namespace

Sample sample_of(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(place);
    const auto high = std::min(low + 1, values.size() - 1);
    return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
  };
  return {at(0.5), (at(0.75) - at(0.25)) / 2};
}

double bytes_per_particle_substep(const Plan& plan) {
  const BufferRow& row = row_of(BufferId::position);
  return 4.0 * (plan.in_double() ? row.element_bytes_double : row.element_bytes);
}

double CopyBandwidth::best_gb_s() const { return std::max(command_gb_s.median, shader_gb_s.median); }

std::string CopyBandwidth::best() const {
  return command_gb_s.median >= shader_gb_s.median ? "command" : "shader";
}

BenchReport bench(gpu::Device& device, const Scene& scene, const BenchOptions& options) {
  if (!device.info().timestamps)
    throw error(Exit::no_device, "{} has no timestamps; bench needs them", device.info().name);
  const Model first = build_model(scene);
  require_precision(device, first, planned(first));
  BenchReport report{.device = device.info().name,
                     .driver = device.info().driver,
                     .scene = scene.title,
                     .solver = scene.solver.name,
                     .precision = scene.solver.precision,
                     .repetitions = options.repetitions};
  CopyBench copy(device);
  std::vector<std::unique_ptr<SizeBench>> sizes;
  for (const Scene& variant : variants(scene, options))
    if (fits(device, variant))
      for (const std::string& kernel : kernels_for(device, variant, options))
        sizes.push_back(std::make_unique<SizeBench>(device, variant, options, kernel));
  for (std::uint32_t repetition = 0; repetition < options.repetitions; ++repetition)
    for (const auto& size : sizes) {
      copy.run();
      size->run();
    }
  report.copy = copy.result();
  for (const auto& size : sizes) report.rows.push_back(size->result(report.copy.best_gb_s()));
  return report;
}

}  // namespace weft
