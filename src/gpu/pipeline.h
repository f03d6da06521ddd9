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
  explicit PipelineCache(Device&);
  ~PipelineCache();  ///< saves: temporary name, then rename
  VkPipelineCache handle() const;
  std::filesystem::path file() const;
  void save();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class ComputePipeline {
 public:
  ComputePipeline() = default;
  /// Specialization constants are 32-bit words, id = place in the list.
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
