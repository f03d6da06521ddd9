// Builds one graphics pipeline from its options; viewport and scissor stay dynamic.
#include "render/draw_pipeline.h"

#include <string>
#include <utility>
#include <vector>

#include "gpu/pipeline.h"
#include "gpu/shader.h"

namespace weft {
namespace {

class ShaderModule {
 public:
  ShaderModule(gpu::Device& device, std::string_view name) : device_(device) {
    const std::vector<std::uint32_t> words = gpu::load_spirv(name);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size() * sizeof(std::uint32_t);
    info.pCode = words.data();
    gpu::check(vkCreateShaderModule(device.handle(), &info, nullptr, &handle_),
               "create a draw shader module");
  }
  ~ShaderModule() { vkDestroyShaderModule(device_.handle(), handle_, nullptr); }
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;
  VkShaderModule handle() const { return handle_; }

 private:
  gpu::Device& device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

/// The fixed-function state, kept together because Vulkan takes pointers into it.
struct FixedState {
  VkVertexInputBindingDescription streams[2] = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX},
                                                {1, 16, VK_VERTEX_INPUT_RATE_VERTEX}};
  VkVertexInputAttributeDescription attributes[2] = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
                                                     {1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, 0}};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendAttachmentState blend{};
  VkPipelineColorBlendStateCreateInfo color{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  VkDynamicState dynamics[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};

  explicit FixedState(const DrawPipelineOptions& options) {
    input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = options.attributes;
    input.pVertexBindingDescriptions = streams;
    input.pVertexAttributeDescriptions = attributes;
    assembly.topology = options.topology;
    viewport.viewportCount = viewport.scissorCount = 1;
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = options.cull_back ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0f;
    raster.depthBiasEnable = options.shadow ? VK_TRUE : VK_FALSE;
    raster.depthBiasSlopeFactor = 1.5f;
    samples.rasterizationSamples = options.samples;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = options.writes_depth ? VK_TRUE : VK_FALSE;
    // The picture's depth is reversed (1 near), the shadow map's is not.
    depth.depthCompareOp = options.shadow ? VK_COMPARE_OP_LESS_OR_EQUAL : VK_COMPARE_OP_GREATER_OR_EQUAL;
    blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                           VK_COLOR_COMPONENT_A_BIT;
    const bool colored = options.color_format != VK_FORMAT_UNDEFINED;
    color.attachmentCount = rendering.colorAttachmentCount = colored ? 1 : 0;
    color.pAttachments = &blend;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamics;
    rendering.pColorAttachmentFormats = &options.color_format;
    rendering.depthAttachmentFormat = kDepthFormat;
  }
};

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits which, const ShaderModule& module) {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = which;
  info.module = module.handle();
  info.pName = "main";
  return info;
}

}  // namespace

DrawPipeline::DrawPipeline(gpu::Device& device, VkPipelineLayout layout, const DrawPipelineOptions& options)
    : device_(&device) {
  const ShaderModule vertex(device, options.vertex);
  std::vector<VkPipelineShaderStageCreateInfo> stages{stage(VK_SHADER_STAGE_VERTEX_BIT, vertex)};
  const bool depth_only = options.fragment.empty();
  const ShaderModule fragment(device, depth_only ? options.vertex : options.fragment);
  const VkSpecializationMapEntry entries[] = {{0, 0, 4}, {1, 4, 4}, {2, 8, 4}};
  const VkSpecializationInfo constants{std::size(entries), entries, sizeof options.constants,
                                       options.constants.data()};
  if (!depth_only) {
    stages.push_back(stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment));
    stages.back().pSpecializationInfo = &constants;
  }
  const FixedState fixed(options);
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &fixed.rendering};
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &fixed.input;
  info.pInputAssemblyState = &fixed.assembly;
  info.pViewportState = &fixed.viewport;
  info.pRasterizationState = &fixed.raster;
  info.pMultisampleState = &fixed.samples;
  info.pDepthStencilState = &fixed.depth;
  info.pColorBlendState = &fixed.color;
  info.pDynamicState = &fixed.dynamic;
  info.layout = layout;
  gpu::check(vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache().handle(), 1, &info, nullptr,
                                       &handle_),
             "create a draw pipeline");
  device.name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(handle_), std::string(options.name));
}

DrawPipeline::~DrawPipeline() {
  if (device_ != nullptr) vkDestroyPipeline(device_->handle(), handle_, nullptr);
}

DrawPipeline::DrawPipeline(DrawPipeline&& other) noexcept
    : device_(std::exchange(other.device_, nullptr)), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}

DrawPipeline& DrawPipeline::operator=(DrawPipeline&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  return *this;
}

}  // namespace weft
