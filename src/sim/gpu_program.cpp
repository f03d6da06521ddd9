// The plan's buffers and pipelines on a device, and how one of its steps is recorded.
#include "sim/gpu_program.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "passes/passes.h"

namespace weft {
namespace {

/// Particles of the cloth at another resolution: the grid rule of docs/physics.md.
std::uint64_t particles_at(const Scene& scene, std::uint32_t resolution) {
  const double spacing_m = scene.cloth.width_m / (resolution - 1);
  return resolution * static_cast<std::uint64_t>(std::llround(scene.cloth.height_m / spacing_m) + 1);
}

/// How a device runs a step: which module, and how many rows of particles one invocation takes on.
struct Variant {
  std::string module;
  std::uint32_t rows = 1;
  std::vector<std::uint32_t> constants;  ///< after the pass's own
};

/// The one place that chooses. Marching down rows saves loads and coefficients, which is what a software
/// device's time goes to (a third of the time at 16 rows); it keeps at least about 16 rows of workgroups for
/// its threads. A GPU's caches make loads cheap, and it needs the invocations.
Variant variant_for(const gpu::Device& device, const PlanStep& step) {
  Variant variant{"passes/" + std::string(step.pass->name) + ".comp", 1, {}};
  if (step.pass->marches) {
    if (device.info().software) variant.rows = std::clamp(step.range.y / 16, 4u, 16u);
    variant.constants = {variant.rows};
  }
  return variant;
}

VkBufferUsageFlags usage_of(BufferId id) {
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  const bool drawn = id == BufferId::position || id == BufferId::position_next || id == BufferId::normal;
  return drawn ? kStorage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT : kStorage;
}

}  // namespace

void require_fits(gpu::Device& device, const Model& model, const Plan& plan) {
  const std::uint64_t range = device.limits().maxStorageBufferRange;
  const std::uint64_t heap = device.info().memory_bytes;
  std::uint64_t largest = 0, particle_bytes = 0;
  for (const PlanBuffer& buffer : plan.buffers) {
    largest = std::max(largest, buffer.bytes / slot_count(buffer.id));
    if (slot_count(buffer.id) == 1) particle_bytes += row_of(buffer.id).element_bytes;
  }
  if (largest <= range && plan.bytes() <= heap) return;
  const std::uint64_t fixed = plan.bytes() - particle_bytes * model.grid.count();
  const std::uint64_t room = heap > fixed ? (heap - fixed) / particle_bytes : 0;
  const std::uint64_t most = std::min(range / 16, room);
  std::uint32_t fits = model.grid.nx;
  while (fits > 2 && particles_at(model.scene, fits) > most) --fits;
  throw error(Exit::no_device,
              "{}: cloth.resolution {} needs {} bytes, {} of them in one buffer; {} has {} bytes and binds "
              "at most {} "
              "at once; the largest resolution that fits is {}",
              model.scene.source, model.grid.nx, plan.bytes(), largest, device.info().name, heap, range,
              fits);
}

GpuBuffers::GpuBuffers(gpu::Device& device, const Model& model, const Plan& plan) {
  require_fits(device, model, plan);
  for (const PlanBuffer& wanted : plan.buffers) {
    const std::uint32_t slots = slot_count(wanted.id);
    std::vector<gpu::Buffer>& copies = buffers_[wanted.id];
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      std::string name(row_of(wanted.id).name);
      if (slots > 1) name = fmt::format("{}[{}]", name, slot);
      copies.emplace_back(device, std::move(name), wanted.bytes / slots, usage_of(wanted.id),
                          slots > 1 ? gpu::Memory::upload : gpu::Memory::device);
    }
  }
}

gpu::Buffer& GpuBuffers::at(BufferId id, std::uint32_t slot) {
  std::vector<gpu::Buffer>& copies = buffers_.at(id);
  return copies[copies.size() == 1 ? 0 : slot];
}

const gpu::Buffer& GpuBuffers::at(BufferId id, std::uint32_t slot) const {
  const std::vector<gpu::Buffer>& copies = buffers_.at(id);
  return copies[copies.size() == 1 ? 0 : slot];
}

std::uint64_t GpuBuffers::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& [id, copies] : buffers_)
    for (const gpu::Buffer& buffer : copies) sum += buffer.bytes();
  return sum;
}

BufferId at_parity(BufferId id, Parity parity) {
  if (parity == 0) return id;
  switch (id) {
    case BufferId::position: return BufferId::position_next;
    case BufferId::position_next: return BufferId::position;
    case BufferId::velocity: return BufferId::velocity_next;
    case BufferId::velocity_next: return BufferId::velocity;
    default: return id;
  }
}

GpuProgram::GpuProgram(gpu::Device& device, const Plan& plan, const GpuBuffers& buffers,
                       std::shared_ptr<GpuPipelines> pipelines) {
  if (!pipelines) pipelines = std::make_shared<GpuPipelines>(device);
  for (const PlanStep& step : plan.steps) {
    const std::size_t kernel = kernel_for(device, step, buffers, *pipelines);
    const auto& local = kernels_[kernel].pipeline->reflection().local_size;
    const std::uint32_t rows = local[1] * kernels_[kernel].rows;
    steps_.push_back(
        {kernel, (step.range.x + local[0] - 1) / local[0], (step.range.y + rows - 1) / rows, step.item});
  }
}

std::size_t GpuProgram::kernel_for(gpu::Device& device, const PlanStep& step, const GpuBuffers& buffers,
                                   GpuPipelines& pipelines) {
  const Variant variant = variant_for(device, step);
  std::vector<std::uint32_t> constants;
  for (const Constant& constant : step.constants) constants.push_back(constant.value);
  constants.insert(constants.end(), variant.constants.begin(), variant.constants.end());
  for (std::size_t k = 0; k < kernels_.size(); ++k)
    if (kernels_[k].module == variant.module && kernels_[k].constants == constants) return k;

  Kernel kernel;
  kernel.module = variant.module;
  kernel.rows = variant.rows;
  kernel.constants = constants;
  kernel.pipeline = pipelines.get(variant.module, std::string(step.pass->name), kernel.constants);
  const auto& bindings = kernel.pipeline->reflection().bindings;
  kernel.flips = step.pass->swaps_state;
  for (Parity parity = 0; parity < 2; ++parity)
    for (std::uint32_t slot = 0; slot < kFrameSlots; ++slot) {
      std::vector<gpu::BoundBuffer> bound;
      for (const gpu::Binding& binding : bindings)
        bound.push_back({binding.binding, &buffers.at(at_parity(BufferId{binding.binding}, parity), slot)});
      kernel.sets.emplace_back(device, *kernel.pipeline, bound);
    }
  kernels_.push_back(std::move(kernel));
  return kernels_.size() - 1;
}

bool GpuProgram::flips(std::size_t step) const { return kernels_[steps_[step].kernel].flips; }

void GpuProgram::dispatch(gpu::Recorder& recorder, std::size_t step, Parity parity, std::uint32_t slot,
                          std::uint32_t row) const {
  const Step& place = steps_[step];
  const Kernel& kernel = kernels_[place.kernel];
  const std::array<std::uint32_t, 2> words{row, place.item};
  const std::size_t taken = kernel.pipeline->reflection().push_constant_bytes / sizeof(std::uint32_t);
  const auto push = std::as_bytes(std::span(words).first(taken));
  recorder.dispatch(*kernel.pipeline, kernel.sets[parity * kFrameSlots + slot], place.groups_x,
                    place.groups_y, push);
}

}  // namespace weft
