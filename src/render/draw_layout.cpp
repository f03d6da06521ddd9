// The descriptor layout of the draw shaders and its sets.
#include <glm/mat4x4.hpp>

#include "render/draw_pipeline.h"

namespace weft {
namespace {

bool filters_depth(gpu::Device& device) {
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(device.physical(), kDepthFormat, &properties);
  return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
}

}  // namespace

DrawLayout::DrawLayout(gpu::Device& device, const gpu::Buffer& view, const gpu::Image& shadow_map)
    : device_(device) {
  create_samplers();
  create_layout();
  write_sets(view, shadow_map);
}

DrawLayout::~DrawLayout() {
  vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
  vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
  vkDestroyDescriptorSetLayout(device_.handle(), set_layout_, nullptr);
  vkDestroySampler(device_.handle(), plain_, nullptr);
  vkDestroySampler(device_.handle(), compare_, nullptr);
}

void DrawLayout::create_samplers() {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.magFilter = info.minFilter = VK_FILTER_NEAREST;
  gpu::check(vkCreateSampler(device_.handle(), &info, nullptr, &plain_), "create the shadow depth sampler");
  // Comparing before filtering gives four soft taps for one, where the device can.
  if (filters_depth(device_)) info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.compareEnable = VK_TRUE;
  info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  gpu::check(vkCreateSampler(device_.handle(), &info, nullptr, &compare_), "create the shadow sampler");
}

void DrawLayout::create_layout() {
  constexpr VkShaderStageFlags kBoth = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
  const VkDescriptorSetLayoutBinding bindings[] = {
      {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kBoth, nullptr},
      {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
      {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr},
      {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_VERTEX_BIT, nullptr}};
  VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set_info.bindingCount = std::size(bindings);
  set_info.pBindings = bindings;
  gpu::check(vkCreateDescriptorSetLayout(device_.handle(), &set_info, nullptr, &set_layout_),
             "create the draw descriptor layout");

  VkPipelineLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &set_layout_;
  const VkPushConstantRange frame{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(glm::mat4)};
  layout_info.pushConstantRangeCount = 1;
  layout_info.pPushConstantRanges = &frame;
  gpu::check(vkCreatePipelineLayout(device_.handle(), &layout_info, nullptr, &layout_),
             "create the draw pipeline layout");
  device_.name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, reinterpret_cast<std::uint64_t>(layout_), "draw layout");

  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kDrawSlots},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2 * kDrawSlots},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kDrawSlots}};
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = kDrawSlots;
  pool_info.poolSizeCount = std::size(sizes);
  pool_info.pPoolSizes = sizes;
  gpu::check(vkCreateDescriptorPool(device_.handle(), &pool_info, nullptr, &pool_),
             "create the draw descriptor pool");

  std::array<VkDescriptorSetLayout, kDrawSlots> layouts;
  layouts.fill(set_layout_);
  VkDescriptorSetAllocateInfo set_allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  set_allocate.descriptorPool = pool_;
  set_allocate.descriptorSetCount = kDrawSlots;
  set_allocate.pSetLayouts = layouts.data();
  gpu::check(vkAllocateDescriptorSets(device_.handle(), &set_allocate, sets_.data()),
             "allocate the draw descriptor sets");
}

void DrawLayout::write_sets(const gpu::Buffer& view, const gpu::Image& shadow_map) {
  const VkDescriptorBufferInfo buffer{view.handle(), 0, VK_WHOLE_SIZE};
  const VkDescriptorImageInfo compare{compare_, shadow_map.view(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
  const VkDescriptorImageInfo plain{plain_, shadow_map.view(), VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
  for (const VkDescriptorSet set : sets_) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.descriptorCount = 1;
    std::array<VkWriteDescriptorSet, 3> writes{write, write, write};
    writes[0].descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    writes[0].pBufferInfo = &buffer;
    writes[1].dstBinding = 1;
    writes[1].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[1].pImageInfo = &compare;
    writes[2].dstBinding = 2;
    writes[2].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[2].pImageInfo = &plain;
    vkUpdateDescriptorSets(device_.handle(), std::size(writes), writes.data(), 0, nullptr);
  }
}

void DrawLayout::bind_positions(std::uint32_t slot, VkBuffer position) {
  const VkDescriptorBufferInfo buffer{position, 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = sets_[slot];
  write.dstBinding = 3;
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &buffer;
  vkUpdateDescriptorSets(device_.handle(), 1, &write, 0, nullptr);
}

}  // namespace weft
