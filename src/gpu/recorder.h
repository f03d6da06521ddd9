// Records labelled dispatches; barriers follow from what each pipeline reads and writes.
#pragma once
#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "gpu/pipeline.h"

namespace weft::gpu {

class Recorder {
 public:
  /// Assumes nothing of earlier command buffers: begins with a barrier against all their writes.
  Recorder(Device&, VkCommandBuffer);
  void label(std::string_view text);  ///< opens a debug label; closed by end_label or the destructor
  void end_label();
  /// Binds, inserts the barriers needed since the latest use of each buffer, dispatches.
  void dispatch(const ComputePipeline&, const DescriptorSet&, std::uint32_t groups_x, std::uint32_t groups_y,
                std::span<const std::byte> push_constants = {});
  /// Makes all shader writes so far visible to vertex input, transfer and host reads.
  void finish();
  std::uint64_t dispatch_count() const;

 private:
  struct Use {
    VkBuffer buffer;
    bool read, written;
  };
  Device& device_;
  VkCommandBuffer commands_;
  VkPipeline bound_ = VK_NULL_HANDLE;
  std::vector<Use> uses_;
  std::uint64_t dispatches_ = 0;
  int labels_ = 0;
};

/// Timestamps on the device; empty answers where the device has none.
class Timer {
 public:
  Timer(Device&, std::uint32_t slots);
  ~Timer();
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;
  void reset(VkCommandBuffer);
  void stamp(VkCommandBuffer, std::uint32_t slot);
  /// Milliseconds between two slots, once their work is finished; negative when not available.
  double between_ms(std::uint32_t first, std::uint32_t second) const;

 private:
  Device& device_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  std::uint32_t slots_;
};

}  // namespace weft::gpu
