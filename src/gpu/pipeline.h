// Compute pipelines, their descriptor sets, and the pipeline cache on disk.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/shader.h"

namespace weft::gpu {

/// VkPipelineCache kept in $XDG_CACHE_HOME/weft (else ~/.cache/weft), one file a device and driver.
/// A damaged or foreign file is ignored and rewritten.
class PipelineCache {
 public:
  /// @param folder  where the file lies; empty: the cache folder above
  explicit PipelineCache(Device&, std::filesystem::path folder = {});
  PipelineCache(const PipelineCache&) = delete;
  PipelineCache& operator=(const PipelineCache&) = delete;
  ~PipelineCache();  ///< saves: temporary name, then rename
  VkPipelineCache handle() const;
  std::filesystem::path file() const;
  bool loaded() const;  ///< the file was there, whole, and this device's
  void save();          ///< writes nothing when the driver added nothing; a failure is only a warning

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A shader module, for as long as pipelines are made of it.
class ShaderModule {
 public:
  ShaderModule(Device&, std::span<const std::uint32_t> spirv, const std::string& name);
  ~ShaderModule();
  ShaderModule(const ShaderModule&) = delete;
  ShaderModule& operator=(const ShaderModule&) = delete;
  VkShaderModule handle() const { return handle_; }

 private:
  Device& device_;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

class ComputePipeline {
 public:
  ComputePipeline() = default;
  /// Specialization constants are 32-bit words, id = place in the list.
  /// @throws Error(Exit::no_device) when the workgroup is larger than the device allows
  ComputePipeline(Device&, std::string name, std::span<const std::uint32_t> spirv,
                  std::span<const std::uint32_t> constants);
  ~ComputePipeline();
  ComputePipeline(ComputePipeline&&) noexcept;
  ComputePipeline& operator=(ComputePipeline&&) noexcept;
  VkPipeline handle() const;
  VkPipelineLayout layout() const;
  VkDescriptorSetLayout set_layout() const;
  const Reflection& reflection() const;
  const std::string& name() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The buffers bound to a pipeline's bindings, in a pool of its own.
struct BoundBuffer {
  std::uint32_t binding;
  const Buffer* buffer;
  VkFormat texel_format = VK_FORMAT_R32G32B32A32_SFLOAT;  ///< where the shader has a texel buffer
  VkDeviceSize offset = 0;                                ///< bytes; elsewhere than in texel buffers
  VkDeviceSize bytes = VK_WHOLE_SIZE;
};
class DescriptorSet {
 public:
  DescriptorSet() = default;
  /// Every binding of the pipeline must be given; others are ignored.
  DescriptorSet(Device&, const ComputePipeline&, std::span<const BoundBuffer>);
  ~DescriptorSet();
  DescriptorSet(DescriptorSet&&) noexcept;
  DescriptorSet& operator=(DescriptorSet&&) noexcept;
  VkDescriptorSet handle() const;
  const Buffer& buffer(std::uint32_t binding) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace weft::gpu
