// The plan's buffers and pipelines on a device, and how one of its steps is recorded.
#include "sim/gpu_program.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "passes/passes.h"
#include "scene/grid_rule.h"

namespace weft {
namespace {

/// Bytes that the plan's buffers take for the cloth at some resolution.
struct Need {
  std::uint64_t total = 0, largest = 0;  ///< all of them; the largest single one
};

/// Nothing where the cloth would have one row only.
std::optional<Need> need_at(const Model& model, const Plan& plan, std::uint32_t resolution) {
  Model other;
  other.scene = model.scene;
  other.scene.cloth.resolution = resolution;
  if (rows_along_height(other.scene.cloth) < 2.0) return std::nullopt;
  other.grid = build_grid(other.scene);
  other.half_thickness_m = model.half_thickness_m;
  Need need;
  for (const PlanBuffer& buffer : plan.buffers) {
    const std::uint64_t bytes = slot_bytes(buffer.id, other, plan.row_count(), plan.in_double());
    need.largest = std::max(need.largest, bytes);
    need.total += bytes * slot_count(buffer.id);
  }
  return need;
}

VkBufferUsageFlags usage_of(BufferId id) {
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  switch (id) {
    case BufferId::position:
    case BufferId::position_next:
      return kStorage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    case BufferId::built_position:
    case BufferId::patches:
    case BufferId::blocks:
    case BufferId::velocity:
    case BufferId::velocity_next: return kStorage | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    case BufferId::draw_position:
    case BufferId::draw_normal:
    case BufferId::normal: return kStorage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
    case BufferId::band_scratch: return kStorage | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    case BufferId::torn_mesh: return kStorage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    case BufferId::reach_groups:
    case BufferId::collision_state: return kStorage | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    default: return kStorage;
  }
}

/// The id of `sheet_rows` (shaders/shared/sheets.glsl): beyond all that passes and kernels have.
constexpr std::size_t kSheetRowsConstant = 30;
/// And those of `asks_links` and `tears` (shaders/shared/reach.glsl), before it.
constexpr std::size_t kAsksLinksConstant = 29, kTearsConstant = 28;

/// What the host writes or reads every frame, without a copy between; devices seldom touch it.
bool host_reaches(BufferId id) {
  return host_written(id) || id == BufferId::watch_state || id == BufferId::spread_state;
}

}  // namespace

void require_precision(const gpu::Device& device, const Model& model, const Plan& plan) {
  if (!plan.in_double() || device.info().float64) return;
  throw error(Exit::no_device, "{}: solver.precision is f64, and {}; --device cpu computes it, too",
              place_of(model.scene, "solver.precision"), gpu::no_float64(device.info(), gpu::list_devices()));
}

void require_fits(gpu::Device& device, const Model& model, const Plan& plan) {
  const std::uint64_t range = device.limits().maxStorageBufferRange;
  const std::uint64_t heap = device.info().memory_bytes;
  const auto fits = [&](const std::optional<Need>& need) {
    return !need || (need->largest <= range && need->total <= heap);
  };
  const std::optional<Need> need = need_at(model, plan, model.grid.nx);
  if (fits(need)) return;
  std::uint32_t most = 1, too_many = model.grid.nx;  // bytes grow with the resolution
  while (too_many - most > 1) {
    const std::uint32_t middle = most + (too_many - most) / 2;
    (fits(need_at(model, plan, middle)) ? most : too_many) = middle;
  }
  throw error(Exit::no_device,
              "{}: cloth.resolution {} needs {} bytes, {} of them in one buffer; {} has {} bytes and binds "
              "at most {} at once; {}",
              place_of(model.scene, "cloth.resolution"), model.grid.nx, need->total, need->largest,
              device.info().name, heap, range,
              most > 1 && need_at(model, plan, most)
                  ? fmt::format("the largest resolution that fits is {}", most)
                  : std::string("no resolution of this cloth fits"));
}

GpuBuffers::GpuBuffers(gpu::Device& device, const Model& model, const Plan& plan, const Kernel& kernel) {
  require_precision(device, model, plan);
  require_fits(device, model, plan);
  for (const PlanBuffer& wanted : plan.buffers) {
    const std::uint32_t slots = slot_count(wanted.id);
    std::vector<gpu::Buffer>& copies = buffers_[wanted.id];
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      std::string name(row_of(wanted.id).name);
      if (slots > 1) name = fmt::format("{}[{}]", name, slot);
      copies.emplace_back(device, std::move(name), wanted.bytes / slots, usage_of(wanted.id),
                          host_reaches(wanted.id) ? gpu::Memory::upload : gpu::Memory::device);
    }
  }
  if (const std::optional<KernelScratch> scratch = scratch_of(kernel, plan)) {
    const std::string name(row_of(scratch->id).name);
    gpu::Buffer& made = buffers_[scratch->id].emplace_back(device, name, scratch->bytes,
                                                           usage_of(scratch->id), gpu::Memory::device);
    if (scratch->id == BufferId::queue_heads) made.write(std::vector<std::byte>(scratch->bytes));
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
  if (id == BufferId::band_texels) return BufferId::band_scratch;
  if (parity == 0) return id;
  switch (id) {
    case BufferId::position: return BufferId::position_next;
    case BufferId::position_next: return BufferId::position;
    case BufferId::velocity: return BufferId::velocity_next;
    case BufferId::velocity_next: return BufferId::velocity;
    default: return id;
  }
}

/// How a step runs: which module, with which constants after the pass's own, and what an invocation takes on.
struct GpuProgram::Variant {
  std::string module;
  std::vector<std::uint32_t> constants;
  std::uint32_t columns = 1, rows = 1;
};

/// The one place that says what a kernel is on a device. Workgroups are small on software devices, where each
/// is one thread's, and of 64 elsewhere.
GpuProgram::Variant GpuProgram::variant_for(const gpu::Device& device, const PlanStep& step,
                                            const Kernel& kernel, bool several, bool doubles) {
  const std::string name = "passes/" + std::string(step.pass->name);
  const auto local = [&](std::uint32_t needed) {
    const std::uint32_t most = device.info().software ? 256 : 64;
    return std::min((needed + 7) / 8 * 8, most);
  };
  const std::uint32_t strips = (step.range.x + kernel.columns - 1) / kernel.columns;
  if (step.pass == &integrate && several)
    return {name + "_bands.comp", {kernel.columns, kernel.substeps, local(strips)}, kernel.columns, 0};
  if (step.pass == &integrate && kernel.kind == KernelKind::steal)
    return {name + "_steal.comp",
            {kernel.columns, kernel.rows, device.info().subgroup_size},
            kernel.columns,
            kernel.rows};
  if (step.pass == &integrate && kernel.kind >= KernelKind::strip) {
    const std::uint32_t wide = device.info().software ? 64 / kernel.columns : 64;
    return {name + "_strip.comp",
            {kernel.columns, kernel.rows, std::min(local(strips), wide)},
            kernel.columns,
            kernel.rows};
  }
  const std::uint32_t rows = step.pass == &integrate ? kernel.rows
                             : step.pass->marches    ? march_rows(device, step.range.y)
                                                     : 1;
  const std::vector<std::uint32_t> constants(step.pass->marches ? 1 : 0, rows);
  const bool texel = step.pass == &integrate && kernel.kind == KernelKind::texel;
  const bool texels = step.pass->takes_texels && !doubles && kernel.kind != KernelKind::direct;
  return {name + (texel ? "_texel.comp" : ".comp") +
              (doubles  ? "+WEFT_F64"
               : texels ? "+WEFT_TEXELS"
                        : ""),
          constants, 1, rows};
}

GpuProgram::GpuProgram(gpu::Device& device, const Plan& plan, const GpuBuffers& buffers,
                       std::shared_ptr<GpuPipelines> pipelines, const std::optional<Kernel>& kernel)
    : kernel_(kernel ? *kernel : direct_kernel(device, plan)),
      doubles_(plan.in_double()),
      reaching_(plan.reaching),
      sheet_rows_(plan.sheet_rows),
      tells_kicks_(plan.tells_kicks) {
  if (!pipelines) pipelines = std::make_shared<GpuPipelines>(device);
  for (const PlanStep& step : plan.steps) {
    Step& made = steps_.emplace_back(
        Step{work_for(device, step, buffers, *pipelines, false), {}, step.item, nullptr, 0});
    if (kernel_.substeps > 1 && step.pass == &integrate && step.block == Block::substep)
      made.several = work_for(device, step, buffers, *pipelines, true);
    const std::optional<std::uint32_t> reach = plan.reaching.word(step);
    if (!reach && !step.pass->groups_word) continue;
    made.groups = &buffers.at(reach ? BufferId::reach_groups : BufferId::collision_state);
    made.groups_offset = (reach ? *reach : *step.pass->groups_word) * sizeof(std::uint32_t);
  }
}

GpuProgram::Work GpuProgram::work_for(gpu::Device& device, const PlanStep& step, const GpuBuffers& buffers,
                                      GpuPipelines& pipelines, bool several) {
  Variant variant = variant_for(device, step, kernel_, several, doubles_);
  const bool asked = reaching_.word(step) || (reaching_.asked() && step.pass->tells_reach);
  const bool always = std::ranges::count(buffers_of(*step.pass), BufferId::reach_groups) > 0;
  if (asked && !always) variant.module += "+WEFT_REACH";
  if (tells_kicks_ && step.pass == &integrate) variant.module += "+WEFT_SPREAD";
  const std::size_t pipeline = pipeline_for(device, step, variant, buffers, pipelines);
  if (several) return {pipeline, 1, kernel_.bands};
  if (step.pass == &integrate && kernel_.kind == KernelKind::steal) return {pipeline, kernel_.queues, 1};
  const auto& local = pipelines_[pipeline].pipeline->reflection().local_size;
  const std::uint32_t columns = local[0] * variant.columns, rows = local[1] * variant.rows;
  return {pipeline, (step.range.x + columns - 1) / columns, (step.range.y + rows - 1) / rows};
}

std::size_t GpuProgram::pipeline_for(gpu::Device& device, const PlanStep& step, const Variant& variant,
                                     const GpuBuffers& buffers, GpuPipelines& pipelines) {
  std::vector<std::uint32_t> constants;
  for (const Constant& constant : step.constants) constants.push_back(constant.value);
  constants.insert(constants.end(), variant.constants.begin(), variant.constants.end());
  const auto set = [&](std::size_t id, std::uint32_t value) {
    WEFT_ASSERT(constants.size() <= id);
    constants.resize(id, 0);
    constants.push_back(value);
  };
  if (reaching_.tears && step.pass->tells_reach) set(kTearsConstant, 1);
  if (reaching_.links && step.pass->sees_links) set(kAsksLinksConstant, 1);
  if (sheet_rows_ != 0) set(kSheetRowsConstant, sheet_rows_);
  for (std::size_t k = 0; k < pipelines_.size(); ++k)
    if (pipelines_[k].module == variant.module && pipelines_[k].constants == constants) return k;

  Pipeline made;
  made.module = variant.module;
  made.constants = constants;
  made.pipeline = pipelines.get(variant.module, std::string(step.pass->name), constants);
  const auto& bindings = made.pipeline->reflection().bindings;
  made.flips = step.pass->swaps_state;
  for (Parity parity = 0; parity < 2; ++parity)
    for (std::uint32_t slot = 0; slot < kFrameSlots; ++slot) {
      std::vector<gpu::BoundBuffer> bound;
      for (const gpu::Binding& binding : bindings)
        bound.push_back({binding.binding, &buffers.at(at_parity(BufferId{binding.binding}, parity), slot)});
      made.sets.emplace_back(device, *made.pipeline, bound);
    }
  pipelines_.push_back(std::move(made));
  return pipelines_.size() - 1;
}

bool GpuProgram::flips(std::size_t step) const { return pipelines_[steps_[step].one.pipeline].flips; }

void GpuProgram::dispatch(gpu::Recorder& recorder, std::size_t step, Parity parity, std::uint32_t slot,
                          std::uint32_t row, std::uint32_t substeps) const {
  const Step& place = steps_[step];
  const Work& work = substeps > 1 ? place.several.value() : place.one;
  const Pipeline& used = pipelines_[work.pipeline];
  const std::array<std::uint32_t, 2> words{row, substeps > 1 ? substeps : place.item};
  const std::size_t taken = used.pipeline->reflection().push_constant_bytes / sizeof(std::uint32_t);
  const auto push = std::as_bytes(std::span(words).first(taken));
  if (place.groups != nullptr)
    return recorder.dispatch_indirect(*used.pipeline, used.sets[parity * kFrameSlots + slot], *place.groups,
                                      place.groups_offset, push);
  recorder.dispatch(*used.pipeline, used.sets[parity * kFrameSlots + slot], work.groups_x, work.groups_y,
                    push);
}

}  // namespace weft
