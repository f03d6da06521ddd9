// Recording dispatches with the barriers they need, and timestamps.
#include "gpu/recorder.h"

#include <algorithm>
#include <array>
#include <string>

#include "core/error.h"

namespace weft::gpu {
namespace {

constexpr VkPipelineStageFlags2 kCompute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkAccessFlags2 kShaderUse =
    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;

void memory_barrier(VkCommandBuffer commands, VkPipelineStageFlags2 from, VkAccessFlags2 written,
                    VkPipelineStageFlags2 to, VkAccessFlags2 used) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, nullptr, from, written, to, used};
  VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  dependency.memoryBarrierCount = 1;
  dependency.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

Recorder::Recorder(Device& device, VkCommandBuffer commands, Barriers barriers)
    : device_(device), commands_(commands), barriers_(barriers) {
  memory_barrier(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT, kCompute,
                 kShaderUse);
}

Recorder::~Recorder() {
  while (labels_ > 0) end_label();
}

void Recorder::label(std::string_view text) {
  device_.begin_label(commands_, std::string(text));
  ++labels_;
}

void Recorder::end_label() {
  if (labels_ == 0) return;
  device_.end_label(commands_);
  --labels_;
}

/// A read after a write, a write after a read, or a write after a write, since the latest barrier.
bool Recorder::conflicts(const ComputePipeline& pipeline, const DescriptorSet& set) const {
  for (const Binding& binding : pipeline.reflection().bindings) {
    const VkBuffer buffer = set.buffer(binding.binding).handle();
    for (const Use& use : uses_) {
      if (use.buffer != buffer) continue;
      if (use.written || (use.read && binding.writes)) return true;
    }
  }
  return false;
}

void Recorder::note_uses(const ComputePipeline& pipeline, const DescriptorSet& set) {
  for (const Binding& binding : pipeline.reflection().bindings) {
    const VkBuffer buffer = set.buffer(binding.binding).handle();
    auto use = std::find_if(uses_.begin(), uses_.end(), [&](const Use& u) { return u.buffer == buffer; });
    if (use == uses_.end()) use = uses_.insert(uses_.end(), Use{buffer, false, false});
    use->read = use->read || binding.reads;
    use->written = use->written || binding.writes;
  }
}

void Recorder::bind(const ComputePipeline& pipeline, const DescriptorSet& set) {
  if (bound_ != pipeline.handle()) {
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
    bound_ = pipeline.handle();
    bound_set_ = VK_NULL_HANDLE;
  }
  const VkDescriptorSet handle = set.handle();
  if (bound_set_ == handle) return;
  vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout(), 0, 1, &handle, 0,
                          nullptr);
  bound_set_ = handle;
}

void Recorder::dispatch(const ComputePipeline& pipeline, const DescriptorSet& set, std::uint32_t groups_x,
                        std::uint32_t groups_y, std::span<const std::byte> push_constants) {
  const auto& most = device_.limits().maxComputeWorkGroupCount;
  if (groups_x > most[0] || groups_y > most[1]) {
    throw error(Exit::no_device,
                "Pass {} needs {}x{} workgroups; device \"{}\" runs at most {}x{}; lower the resolution",
                pipeline.name(), groups_x, groups_y, device_.info().name, most[0], most[1]);
  }
  order(pipeline, set, false);
  bind(pipeline, set);
  push(pipeline, push_constants);
  vkCmdDispatch(commands_, groups_x, groups_y, 1);
  note_uses(pipeline, set);
  ++dispatches_;
}

void Recorder::dispatch_indirect(const ComputePipeline& pipeline, const DescriptorSet& set,
                                 const Buffer& groups, VkDeviceSize offset,
                                 std::span<const std::byte> push_constants) {
  order(pipeline, set, true);
  bind(pipeline, set);
  push(pipeline, push_constants);
  vkCmdDispatchIndirect(commands_, groups.handle(), offset);
  note_uses(pipeline, set);
  indirect_ = true;
  ++dispatches_;
}

/// The barrier that the dispatch needs, if any. An indirect one always gets one: its workgroups were written
/// by a pass that an earlier barrier may have ordered against shaders only.
void Recorder::order(const ComputePipeline& pipeline, const DescriptorSet& set, bool indirect) {
  if (barriers_ != Barriers::automatic || !(indirect || conflicts(pipeline, set))) return;
  constexpr VkPipelineStageFlags2 kIndirect = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
  // One barrier for all buffers: per-buffer barriers cost the same and order nothing less.
  memory_barrier(commands_, indirect_ ? kCompute | kIndirect : kCompute, VK_ACCESS_2_SHADER_WRITE_BIT,
                 indirect ? kCompute | kIndirect : kCompute,
                 indirect ? kShaderUse | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT : kShaderUse);
  uses_.clear();
  indirect_ = false;
  ++barrier_count_;
}

void Recorder::push(const ComputePipeline& pipeline, std::span<const std::byte> push_constants) {
  if (push_constants.size() != pipeline.reflection().push_constant_bytes)
    throw error(Exit::internal, "Pass {} takes {} bytes of push constants and was given {}", pipeline.name(),
                pipeline.reflection().push_constant_bytes, push_constants.size());
  if (push_constants.empty()) return;
  vkCmdPushConstants(commands_, pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                     static_cast<std::uint32_t>(push_constants.size()), push_constants.data());
}

void Recorder::finish() {
  constexpr VkPipelineStageFlags2 kReaders =
      VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
      VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
  constexpr VkAccessFlags2 kReads = VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT |
                                    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
                                    VK_ACCESS_2_HOST_READ_BIT;
  memory_barrier(commands_, kCompute, VK_ACCESS_2_SHADER_WRITE_BIT, kReaders, kReads);
}

Timer::Timer(Device& device, std::uint32_t slots) : device_(device), slots_(slots) {
  if (device.timestamp_valid_bits() == 0 || slots == 0) return;
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = slots;
  check(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_), "create a timestamp pool");
}

Timer::~Timer() { vkDestroyQueryPool(device_.handle(), pool_, nullptr); }

void Timer::reset(VkCommandBuffer commands) {
  if (available()) vkCmdResetQueryPool(commands, pool_, 0, slots_);
}

void Timer::stamp(VkCommandBuffer commands, std::uint32_t slot) {
  WEFT_ASSERT(slot < slots_);
  if (available()) vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, slot);
}

double Timer::between_ms(std::uint32_t first, std::uint32_t second) const {
  if (!available()) return -1.0;
  const auto stamp_of = [&](std::uint32_t slot, std::uint64_t& ticks) {
    std::array<std::uint64_t, 2> answer = {0, 0};  // ticks, then whether they are there
    const VkResult result =
        vkGetQueryPoolResults(device_.handle(), pool_, slot, 1, sizeof answer, answer.data(), sizeof answer,
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
    ticks = answer[0];
    return (result == VK_SUCCESS || result == VK_NOT_READY) && answer[1] != 0;
  };
  std::uint64_t from = 0, to = 0;
  if (!stamp_of(first, from) || !stamp_of(second, to)) return -1.0;
  const std::uint32_t bits = device_.timestamp_valid_bits();
  const std::uint64_t mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  return static_cast<double>((to - from) & mask) * device_.timestamp_ns() * 1e-6;
}

}  // namespace weft::gpu
