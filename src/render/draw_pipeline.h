// Graphics pipelines for dynamic rendering, and the one descriptor layout they all share.
#pragma once
#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <string_view>

#include "gpu/buffer.h"
#include "gpu/device.h"

namespace weft {

/// Descriptor sets in flight: one for each picture that may be on its way at the same time.
inline constexpr std::uint32_t kDrawSlots = 3;

/// Push constants: a body's frame, of the vertex stage. Set 0: 0 = view block, 1 = shadow map with
/// comparison, 2 = its depths, 3 = positions (heat map only).
class DrawLayout {
 public:
  DrawLayout(gpu::Device& device, const gpu::Buffer& view, const gpu::Image& shadow_map);
  ~DrawLayout();
  DrawLayout(const DrawLayout&) = delete;
  DrawLayout& operator=(const DrawLayout&) = delete;

  VkPipelineLayout handle() const { return layout_; }
  VkDescriptorSet set(std::uint32_t slot) const { return sets_[slot]; }
  /// The slot's former picture must be finished.
  void bind_positions(std::uint32_t slot, VkBuffer position);

 private:
  void create_samplers();
  void create_layout();
  void write_sets(const gpu::Buffer& view, const gpu::Image& shadow_map);

  gpu::Device& device_;
  VkSampler compare_ = VK_NULL_HANDLE, plain_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  std::array<VkDescriptorSet, kDrawSlots> sets_{};
};

/// What tells one draw pipeline from another.
struct DrawPipelineOptions {
  std::string_view name, vertex, fragment;  ///< shader names below shaders/; no fragment: depth only
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::uint32_t attributes = 0;  ///< vec4 vertex buffers: 1 = position, 2 = position and normal
  bool cull_back = false;
  bool shadow = false;  ///< into the shadow map: near is 0, biased by slope
  bool writes_depth = true;
  VkFormat color_format = VK_FORMAT_UNDEFINED;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  std::array<std::uint32_t, 3> constants{};  ///< of the fragment shader: shadow taps, flat, heat
};

class DrawPipeline {
 public:
  DrawPipeline() = default;
  DrawPipeline(gpu::Device& device, VkPipelineLayout layout, const DrawPipelineOptions& options);
  ~DrawPipeline();
  DrawPipeline(DrawPipeline&& other) noexcept;
  DrawPipeline& operator=(DrawPipeline&& other) noexcept;
  VkPipeline handle() const { return handle_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

 private:
  gpu::Device* device_ = nullptr;
  VkPipeline handle_ = VK_NULL_HANDLE;
};

inline constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

}  // namespace weft
