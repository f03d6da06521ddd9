// Compute pipelines and descriptor sets, both shaped by what the shader's reflection says.
#include "gpu/pipeline.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"

namespace weft::gpu {

ShaderModule::ShaderModule(Device& device, std::span<const std::uint32_t> spirv, const std::string& name)
    : device_(device) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = spirv.size_bytes();
  info.pCode = spirv.data();
  check(vkCreateShaderModule(device.handle(), &info, nullptr, &handle_), "create a shader module");
  device.name(VK_OBJECT_TYPE_SHADER_MODULE, handle_, name);
}

ShaderModule::~ShaderModule() { vkDestroyShaderModule(device_.handle(), handle_, nullptr); }

struct ComputePipeline::Impl {
  Device& device;
  std::string name;
  Reflection reflection;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;

  Impl(Device& owner, std::string text) : device(owner), name(std::move(text)) {}
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  void check_limits() const;
  void create_layouts();
  void create_pipeline(std::span<const std::uint32_t> spirv, std::span<const std::uint32_t> constants);
};

ComputePipeline::Impl::~Impl() {
  vkDestroyPipeline(device.handle(), pipeline, nullptr);
  vkDestroyPipelineLayout(device.handle(), layout, nullptr);
  vkDestroyDescriptorSetLayout(device.handle(), set_layout, nullptr);
}

void ComputePipeline::Impl::check_limits() const {
  const auto& limits = device.limits();
  const auto& size = reflection.local_size;
  const std::uint64_t invocations = std::uint64_t{size[0]} * size[1] * size[2];
  if (invocations > limits.maxComputeWorkGroupInvocations || size[0] > limits.maxComputeWorkGroupSize[0] ||
      size[1] > limits.maxComputeWorkGroupSize[1] || size[2] > limits.maxComputeWorkGroupSize[2]) {
    throw error(Exit::no_device,
                "Pass {} has workgroups of {}x{}x{}; device \"{}\" runs at most {} invocations in "
                "{}x{}x{}; choose another --device",
                name, size[0], size[1], size[2], device.info().name, limits.maxComputeWorkGroupInvocations,
                limits.maxComputeWorkGroupSize[0], limits.maxComputeWorkGroupSize[1],
                limits.maxComputeWorkGroupSize[2]);
  }
  if (reflection.push_constant_bytes > limits.maxPushConstantsSize)
    throw error(Exit::no_device, "Pass {} pushes {} bytes; device \"{}\" takes at most {}", name,
                reflection.push_constant_bytes, device.info().name, limits.maxPushConstantsSize);
  for (const Binding& b : reflection.bindings) {
    if (b.set != 0 || b.count != 1) {
      throw error(Exit::internal,
                  "Pass {} binds set {} binding {} with {} descriptors; compute passes use "
                  "set 0 and one descriptor a binding",
                  name, b.set, b.binding, b.count);
    }
  }
}

void ComputePipeline::Impl::create_layouts() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const Binding& b : reflection.bindings)
    bindings.push_back({b.binding, b.type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set_info.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device.handle(), &set_info, nullptr, &set_layout),
        "create a descriptor set layout");

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, reflection.push_constant_bytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1;
  info.pSetLayouts = &set_layout;
  info.pushConstantRangeCount = reflection.push_constant_bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout), "create a pipeline layout");
}

void ComputePipeline::Impl::create_pipeline(std::span<const std::uint32_t> spirv,
                                            std::span<const std::uint32_t> constants) {
  const ShaderModule module(device, spirv, name);
  std::vector<VkSpecializationMapEntry> entries;
  for (const std::uint32_t id : reflection.constant_ids)
    if (id < constants.size()) entries.push_back({id, id * 4, 4});
  const VkSpecializationInfo specialization{static_cast<std::uint32_t>(entries.size()), entries.data(),
                                            constants.size_bytes(), constants.data()};
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = module.handle();
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &specialization;
  info.layout = layout;
  check(vkCreateComputePipelines(device.handle(), device.pipeline_cache().handle(), 1, &info, nullptr,
                                 &pipeline),
        "compile a compute pipeline");
  device.name(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
}

ComputePipeline::ComputePipeline(Device& device, std::string name, std::span<const std::uint32_t> spirv,
                                 std::span<const std::uint32_t> constants)
    : impl_(std::make_unique<Impl>(device, std::move(name))) {
  impl_->reflection = reflect(spirv, constants);
  impl_->check_limits();
  impl_->create_layouts();
  impl_->create_pipeline(spirv, constants);
}

ComputePipeline::~ComputePipeline() = default;
ComputePipeline::ComputePipeline(ComputePipeline&&) noexcept = default;
ComputePipeline& ComputePipeline::operator=(ComputePipeline&&) noexcept = default;
VkPipeline ComputePipeline::handle() const { return impl_->pipeline; }
VkPipelineLayout ComputePipeline::layout() const { return impl_->layout; }
VkDescriptorSetLayout ComputePipeline::set_layout() const { return impl_->set_layout; }
const Reflection& ComputePipeline::reflection() const { return impl_->reflection; }
const std::string& ComputePipeline::name() const { return impl_->name; }

struct DescriptorSet::Impl {
  Device& device;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::map<std::uint32_t, const Buffer*> buffers;

  explicit Impl(Device& owner) : device(owner) {}
  ~Impl() { vkDestroyDescriptorPool(device.handle(), pool, nullptr); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  void allocate(const ComputePipeline&);
  void write(const Binding&, const BoundBuffer&);
};

namespace {

bool is_texel(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER || type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
}

}  // namespace

void DescriptorSet::Impl::allocate(const ComputePipeline& pipeline) {
  std::map<VkDescriptorType, std::uint32_t> counts;
  for (const Binding& b : pipeline.reflection().bindings) ++counts[b.type];
  if (counts.empty()) counts[VK_DESCRIPTOR_TYPE_STORAGE_BUFFER] = 1;  // a pool of nothing is not allowed
  std::vector<VkDescriptorPoolSize> sizes;
  sizes.reserve(counts.size());
  for (const auto& [type, count] : counts) sizes.push_back({type, count});
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  pool_info.pPoolSizes = sizes.data();
  check(vkCreateDescriptorPool(device.handle(), &pool_info, nullptr, &pool), "create a descriptor pool");
  const VkDescriptorSetLayout layout = pipeline.set_layout();
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorPool = pool;
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  check(vkAllocateDescriptorSets(device.handle(), &info, &set), "allocate a descriptor set");
  device.name(VK_OBJECT_TYPE_DESCRIPTOR_SET, set, pipeline.name());
}

void DescriptorSet::Impl::write(const Binding& binding, const BoundBuffer& bound) {
  const VkDescriptorBufferInfo buffer{bound.buffer->handle(), bound.offset, bound.bytes};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set;
  write.dstBinding = binding.binding;
  write.descriptorCount = 1;
  write.descriptorType = binding.type;
  VkBufferView view = VK_NULL_HANDLE;
  if (is_texel(binding.type)) {
    view = bound.buffer->texel_view(bound.texel_format);
    write.pTexelBufferView = &view;
  } else {
    write.pBufferInfo = &buffer;
  }
  vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
  buffers[binding.binding] = bound.buffer;
}

DescriptorSet::DescriptorSet(Device& device, const ComputePipeline& pipeline,
                             std::span<const BoundBuffer> bound)
    : impl_(std::make_unique<Impl>(device)) {
  impl_->allocate(pipeline);
  for (const Binding& binding : pipeline.reflection().bindings) {
    const auto given = std::find_if(bound.begin(), bound.end(), [&](const BoundBuffer& b) {
      return b.binding == binding.binding && b.buffer != nullptr && *b.buffer;
    });
    if (given == bound.end())
      throw error(Exit::internal, "Pass {} needs a buffer at binding {}, and none is given", pipeline.name(),
                  binding.binding);
    impl_->write(binding, *given);
  }
}

DescriptorSet::~DescriptorSet() = default;
DescriptorSet::DescriptorSet(DescriptorSet&&) noexcept = default;
DescriptorSet& DescriptorSet::operator=(DescriptorSet&&) noexcept = default;
VkDescriptorSet DescriptorSet::handle() const { return impl_->set; }
const Buffer& DescriptorSet::buffer(std::uint32_t binding) const { return *impl_->buffers.at(binding); }

}  // namespace weft::gpu
